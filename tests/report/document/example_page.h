#pragma once

#include "report/document/blocks.h"

namespace shadowbench::document {

inline analysis::Estimate about(double value, double slack = 0.0) {
  return {value, value * (1.0 - slack), value * (1.0 + slack)};
}

/// A chart with everything that a chart can have: both kinds of axes, all lines and marks, whiskers, crowded labels,
/// details, cells to open, a point outside the axes, and names that need escaping.
inline Chart make_example_chart(const std::string& id) {
  Chart chart{id, "Cost & error of <all> filters", "time of the lookup, ms", "RMSE \"to\" the truth", {}, {}, {}, {}};
  chart.x = {true, 0.5, 16.0, {{1.0, "1"}, {2.0, "2"}, {4.0, "4"}, {8.0, "8"}}};
  chart.y = {false, 0.0, 0.1, {{0.0, "0"}, {0.05, "0.05"}, {0.1, "0.1"}}};
  ChartSeries line{"front", "#1c1f24", Mark::kNone, true, false, LineStyle::kSteps, false, {}};
  ChartSeries points{"vsm <b>", "#0072b2", Mark::kDiamond, true, false, LineStyle::kDashed, true, {}};
  ChartSeries beaten{"", "#0072b2", Mark::kSquare, false, true, LineStyle::kNone, true, {}};
  for (int i = 0; i < 6; ++i) {
    const double x = 1.0 + 0.02 * i, y = 0.06 - 0.001 * i;
    line.points.push_back({about(x), about(y), "label " + std::to_string(i + 1)});
    points.points.push_back({about(x, 0.3), about(y, 0.01), {}, {"a detail & more " + std::to_string(i)}});
    points.points.back().opens = "0123456789abcdef";
    beaten.points.push_back({about(2.0 + i), about(0.09)});
  }
  points.points.push_back({about(100.0), about(0.05)});
  ChartSeries ties{"",    "#0072b2",        Mark::kNone, true,
                   false, LineStyle::kTies, false,       {{about(1.0), about(0.06)}, {about(2.0), about(0.09)}}};
  ChartSeries late{"late", "#0072b2",         Mark::kSquare, true,
                   false,  LineStyle::kSolid, false,         {{about(3.0), about(0.03)}}};
  late.hidden = true;
  chart.series = {line, points, beaten, ties, late};
  chart.notes = {"1: vsm (radius 4), map 512",
                 "a note that is so long that it does not fit into one line of a chart on a phone"};
  return chart;
}

/// A page with every kind of block.
inline Page make_example_page() {
  ChartChoice choice{"choice", {{"scene", {"cubes", "stack"}}, {"cost", {"time", "bytes"}}}, {}};
  for (const char* name : {"a", "b", "c", "d"})
    choice.charts.push_back(make_example_chart(std::string("example.") + name));
  Bars bars{"Where the error comes from",
            {{"#f0bf30", "estimator"}},
            -0.01,
            0.04,
            {{"vsm: RMSE 0.03", {{0.0, 0.03, "#f0bf30"}}, 0.03}, {"mine: no attribution", {}}}};
  Page page{"An <example>", {}, {{"../index.html", "the run"}}};
  page.sections = {
      {{}, {}, {Facts{{{"machine", "a_b & c"}}}, Links{"Data:", {{"a b.csv", "a b.csv"}, {"c.json", "its schema"}}}}},
      {"warnings", "Warnings", {Sentences{"Mind:", {"something is odd"}}}, true},
      {"all",
       "Everything",
       {Heading{"A heading"}, Paragraph{"quiet", true},
        Table{"A table", {{"filter", "rmse", "text"}, {{"vsm", "0.25", "short"}, {"a|b", "–", std::string(60, 'x')}}}},
        Table{"Graded",
              {{"scene", "vsm", "esm"}, {{"cubes", "1", "3"}, {"stack", "2", "–"}}},
              {{Grade::kNone, Grade::kGood, Grade::kBad}, {Grade::kNone, Grade::kNear}}},
        Gallery{"Pictures", {{"images/a b.png", "a picture"}}, true}, bars, choice, make_example_chart("single"),
        Details{"More", {Heading{"Within"}, Paragraph{"unfolded"}}}}}};
  return page;
}

}  // namespace shadowbench::document
