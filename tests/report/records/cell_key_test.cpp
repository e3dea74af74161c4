#include "report/records/cell_key.h"

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "reference/metrics/metric_table.h"
#include "report/records/csv_tables.h"
#include "report/records/json_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::records {
namespace {

// Short names say what differs, and no more.

TEST(CellKey, Hash_EqualsPublishedValuesOfFnv1a) {
  EXPECT_EQ(hash_text(""), 0xcbf29ce484222325U);
  EXPECT_EQ(hash_text("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(hash_text("foobar"), 0x85944171f73967e8U);
}

TEST(CellKey, OrderOfKeysAndWayOfWritingNumbers_DoNotMatter) {
  const auto a = nlohmann::json::parse(R"({"x": 4, "y": {"b": 1e-5, "a": true}})");
  const auto b = nlohmann::json::parse(R"({ "y":{"a":true,"b":0.00001}, "x": 4.0 })");
  EXPECT_EQ(cell_key(a), cell_key(b));
}

TEST(CellKey, ARadiusByTheLight_IsNamedByTheLight) {
  CellRecord cell = make_cell("cubes", "vsm", 1.0);
  cell.params["radius"] = 4.0;
  const std::string told = cell_key(cell);
  cell.kernel.by_light = "radius";
  const std::string by_light = cell_key(cell);
  EXPECT_NE(told, by_light);
  cell.params["radius"] = 9.0;
  EXPECT_EQ(cell_key(cell), by_light) << "scene, light and map decide it, and are in the key";
}

TEST(CellKey, EverySetting_ChangesTheKey) {
  const CellRecord cell = make_cell("cubes", "vsm", 4.0);
  const std::map<std::string, nlohmann::json> changes = {{"/scene", "x"},
                                                         {"/view", "x"},
                                                         {"/filter", "x"},
                                                         {"/params/radius", 5.0},
                                                         {"/params/store", "rg16f"},
                                                         {"/params/more", true},
                                                         {"/map_size", 2048},
                                                         {"/map_format", "d16"},
                                                         {"/fit", "view"},
                                                         {"/light", "120,35"},
                                                         {"/bias/constant_depth", 1e-4},
                                                         {"/bias/plane_texels", 1.0},
                                                         {"/bias/plane_kernels", 1.0},
                                                         {"/bias/normal_offset_texels", 1.0},
                                                         {"/bias/receiver_plane", true},
                                                         {"/bias/front_cull", true},
                                                         {"/range/border", "repeat"},
                                                         {"/range/far_test", false},
                                                         {"/range/behind_test", false},
                                                         {"/size/width", 540},
                                                         {"/size/height", 960}};
  std::set<std::string> keys{cell.key};
  for (const auto& [place, value] : changes) {
    nlohmann::json changed = to_json(cell);
    changed[nlohmann::json::json_pointer(place)] = value;
    EXPECT_TRUE(keys.insert(cell_key(cell_from_json(changed, place))).second) << place;
  }
}

TEST(CellKey, Results_DoNotChangeTheKey) {
  EXPECT_EQ(make_cell("cubes", "vsm", 4.0).key, make_cell("cubes", "vsm", 5.0).key);
}

TEST(CellKey, OnlySixteenHexadecimalDigits_AreAKey) {
  EXPECT_TRUE(is_cell_key(make_cell("cubes", "vsm", 4.0).key));
  EXPECT_FALSE(is_cell_key("../../../../etc/x"));
  EXPECT_FALSE(is_cell_key("0123456789ABCDEF"));
  EXPECT_FALSE(is_cell_key(""));
}

CellRecord make_named(const char* filter, const char* fit = "tight", int map_size = 1024, ParamMap params = {}) {
  CellRecord cell;
  cell.filter = filter;
  cell.fit = fit;
  cell.map_size = map_size;
  cell.params = std::move(params);
  return cell;
}

std::vector<std::string> list_names(const std::vector<CellRecord>& cells) {
  const CellNames names(list_each(
      cells, [](const CellRecord& cell) { return &cell; }));
  return list_each(cells, [&](const CellRecord& cell) { return names.name(cell); });
}

constexpr const char* kPractical = "cascades:count=4,split=0.5,blend=0.1,depths=all";

TEST(CellNames, SayWhatDiffers) {
  EXPECT_THAT(list_names({make_named("none"), make_named("vsm", "tight", 1024, {{"radius", 4.0}})}),
              ElementsAre("none", "vsm"));
  EXPECT_THAT(list_names({make_named("vsm", "tight", 1024, {{"radius", 4.0}, {"store", std::string("rg32f")}}),
                          make_named("vsm", "tight", 1024, {{"radius", 8.0}, {"store", std::string("rg32f")}})}),
              ElementsAre("vsm (radius 4)", "vsm (radius 8)"));
  EXPECT_THAT(
      list_names({make_named("pcf2x2"), make_named("pcf2x2", kPractical), make_named("pcf2x2", kPractical, 512)}),
      ElementsAre("pcf2x2, map 1024, tight fit", "pcf2x2, map 1024, 4 cascades", "pcf2x2, map 512, 4 cascades"));
}

TEST(CellNames, OfCascades_NameTheValuesInWhichTheyDiffer) {
  EXPECT_THAT(
      list_names({make_named("none", kPractical), make_named("none", "cascades:count=4,split=1,blend=0.1,depths=all"),
                  make_named("none", "view")}),
      ElementsAre("none, 4 cascades, split 0.5", "none, 4 cascades, split 1", "none, view fit"));
  EXPECT_THAT(list_names({make_named("none", "view"), make_named("none", "view snapped")}),
              ElementsAre("none, view fit", "none, view fit snapped"));
}

TEST(CellNames, NameTheBiasTheLightTheBorderAndThePicture) {
  CellRecord biased = make_named("none"), lit = biased, edged = biased, small = biased;
  biased.bias.map.midpoint = true;
  EXPECT_THAT(list_names({biased, make_named("none")}), ElementsAre("none, bias: midpoint map", "none, bias: none"));
  lit.light = "96,30";
  EXPECT_THAT(list_names({lit, make_named("none")}), ElementsAre("none, light at 96,30", "none, light of the scene"));
  edged.range.border = filters::Border::kEdge;
  EXPECT_THAT(list_names({edged, make_named("none")}), ElementsAre("none, outside the map: edge", "none"));
  small.width = 480;
  EXPECT_THAT(list_names({small, make_named("none")}), Contains("none, picture 480 × 0"));
}

TEST(CellNames, OfABias_DifferByItsLength_NotByTheScaleOfAScenesMap) {
  CellRecord a = make_named("a"), b = make_named("b");
  a.bias.plane_kernels = b.bias.plane_kernels = 1.0;
  a.bias.constant.depth = b.bias.constant.depth = 0.01;
  a.map_scale = {0.1, 10.0};
  b.map_scale = {0.2, 10.0};
  EXPECT_THAT(list_names({a, b}), ElementsAre("a", "b"));
  b.bias.plane_kernels = 2.0;
  EXPECT_THAT(list_names({a, b}), Contains(HasSubstr("plane over 2")));
}

using CsvRow = std::map<std::string, std::string>;

// Reads CSV by RFC 4180: what a spreadsheet would see. Gives each row's fields by their columns.
std::vector<CsvRow> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text.compare(i, 2, "\"\"") == 0) {
      rows.back().back() += text[++i];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && text[i] == ',') {
      rows.back().emplace_back();
    } else if (!quoted && text.compare(i, 2, "\r\n") == 0) {
      rows.push_back({""});
      ++i;
    } else {
      rows.back().back() += text[i];
    }
  }
  rows.pop_back();
  EXPECT_THAT(rows, Each(SizeIs(rows[0].size())));
  std::vector<CsvRow> named(rows.size() - 1);
  for (std::size_t row = 0; row < named.size(); ++row)
    for (std::size_t i = 0; i < rows[0].size(); ++i) named[row][rows[0][i]] = rows[row + 1].at(i);
  return named;
}

TEST(TimingsCsv, EveryRow_HasEveryColumn) {
  CellRecord failed;
  failed.scene = "a \"scene\",\r\nwith everything";
  failed.status = CellStatus::kCrashed;
  failed.message = "signal 11, \"segfault\"";
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {make_cell("cubes", "vsm", 4.5), failed}));
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_THAT(rows, Each(SizeIs(list_csv_columns(CsvTable::kTimings).size())));
  EXPECT_THAT(rows[1], ::testing::IsSupersetOf<CsvRow::value_type>(
                           {{"scene", failed.scene}, {"message", failed.message}, {"lookup_median_ms", ""}}));
}

TEST(TimingsCsv, Formulas_AreDefused_AndNumbersAreNot) {
  for (const std::string text : {"=cmd", "=1+1", "+cmd", "+1+1", "-cmd", "-1+1", "@SUM(A1)", "\tx"})
    EXPECT_EQ(quote_csv(text), "'" + text);
  EXPECT_EQ(quote_csv("=a,b"), "\"'=a,b\"");
  EXPECT_EQ(quote_csv("\r=a"), "\"'\r=a\"");
  for (const std::string text : {"-1", "-0.5", "-1e-05", "-inf", "1", "a=b", ""}) EXPECT_EQ(quote_csv(text), text);
}

TEST(TimingsCsv, OnlyFieldsThatNeedIt_AreQuoted) {
  EXPECT_EQ(quote_csv("a b; c"), "a b; c");
  EXPECT_EQ(quote_csv("a,b"), "\"a,b\"");
  EXPECT_EQ(quote_csv("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(quote_csv("a\nb"), "\"a\nb\"");
  EXPECT_EQ(quote_csv("a\rb"), "\"a\rb\"");
}

TEST(TimingsCsv, Fields_HoldTheirColumnsValues) {
  CellRecord cell = make_cell("cubes", "vsm", 4.5);
  cell.time_ms.prefilter = Quartiles{12.5, 12.25, 12.75, 8};
  cell.range = {filters::Border::kRepeat, true, false};
  cell.ratio_to_none.static_light = Ratio{1.5, {1.25, 1.75}};
  cell.ratio_to_none.moving = Ratio{2.5, {2.25, 2.75}};
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_THAT(rows.at(0), ::testing::IsSupersetOf<CsvRow::value_type>({{"clock", "CPU time (software rasteriser)"},
                                                                       {"machine", ""},
                                                                       {"params", R"({"radius":4,"store":"rg32f"})"},
                                                                       {"lookup_median_ms", "4.5"},
                                                                       {"border", "repeat"},
                                                                       {"far_test", "on"},
                                                                       {"behind_test", "off"},
                                                                       {"prefilter_q1_ms", "12.25"},
                                                                       {"prefilter_n", "8"},
                                                                       {"map_q3_ms", "3.75"},
                                                                       {"ratio_lookup_median", "1.125"},
                                                                       {"ratio_static_low", "1.25"},
                                                                       {"ratio_moving_high", "2.75"},
                                                                       {"map_bytes", "4194304"},
                                                                       {"key", cell.key}}));
}

TEST(TimingsCsv, ClockAndMachine_AreTheCellsOwn) {
  CellRecord cell = make_cell("cubes", "vsm", 4.5);
  cell.machine = {"A CPU", 3, "A GPU", false, TimerKind::kTimerQuery};
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_EQ(rows.at(0).at("clock"), "GPU time (timer query)");
  EXPECT_EQ(rows.at(0).at("machine"), "A CPU, 3 cores, A GPU, GPU time (timer query)");
}

TEST(TimingsCsv, Numbers_ReadBackAsTheSameDoubles) {
  const double value = 0.1 + 0.2;
  CellRecord cell = make_cell("cubes", "vsm", value);
  const auto rows = parse_csv(make_csv(CsvTable::kTimings, make_run(), {cell}));
  EXPECT_EQ(std::stod(rows.at(0).at("lookup_median_ms")), value);
}

TEST(AccuracyCsv, HoldsTheErrors_AndEmptyFieldsWhereThereAreNone) {
  CellRecord scored = make_scored_cell("cubes", "vsm", 4.5, 0.25);
  scored.error.mean = -0.125;
  scored.truth.se = 0.0009765625;
  const auto rows = parse_csv(make_csv(CsvTable::kAccuracy, make_run(), {scored, make_cell("cubes", "none", 1.0)}));
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_THAT(rows, Each(SizeIs(list_csv_columns(CsvTable::kAccuracy).size())));
  EXPECT_THAT(rows[0], ::testing::IsSupersetOf<CsvRow::value_type>(
                           {{"rmse", "0.25"}, {"mean", "-0.125"}, {"truth_se", "0.0009765625"}, {"max", ""}}));
}

// The column of a record's field: "error.rmse" is rmse, "truth.se" is truth_se, "attribution.model.rms" is model_rms.
std::string column_of(std::string path) {
  for (const char* group : {"error.", "coverage.", "artefact.", "attribution.", "stability."})
    if (path.rfind(group, 0) == 0) path.erase(0, std::string(group).size());
  std::replace(path.begin(), path.end(), '.', '_');
  return path;
}

TEST(AccuracyCsv, EveryFieldOfTheRecord_HasItsColumnAndItsMeaning) {
  std::vector<std::string> names;
  for (const CsvColumn& column : list_csv_columns(CsvTable::kAccuracy)) {
    EXPECT_FALSE(column.meaning.empty()) << column.name;
    EXPECT_THAT(names, Not(Contains(column.name)));
    names.push_back(column.name);
  }
  for (const metrics::Metric& metric : metrics::metric_table()) {
    const bool elsewhere = metric.group() == "cost" || metric.group() == "map_scale";
    if (!elsewhere) EXPECT_THAT(names, Contains(column_of(std::string(metric.path))));
  }
}

TEST(ErrorParts, Percentages_HaveNoNegativeZero) {
  EXPECT_EQ(records::format_share(-0.001), "0 %");
  EXPECT_EQ(records::format_share(-0.12), "-12 %");
  EXPECT_EQ(records::format_share(0.714), "71 %");
  EXPECT_EQ(records::format_rate(0.0423), "4.23 %");
}

TEST(ErrorParts, ReasonForNoAttribution_IsTheCells) {
  records::CellRecord cell = make_cell("cubes", "mine", 1.0);
  EXPECT_EQ(records::explain_no_attribution(cell), "no truth in this run");
  cell.absent["attribution"] = "no model";
  EXPECT_EQ(records::explain_no_attribution(cell), "no model");
  cell.absent = {};
  EXPECT_EQ(records::explain_no_attribution(cell), "not measured");
}

TEST(ErrorParts, OfASuspectCell_AreNone) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.status = records::CellStatus::kSuspect;
  EXPECT_EQ(records::explain_no_attribution(cell), "the filter is suspect");
}

TEST(ErrorParts, WithoutANumericPart_SaySo) {
  records::CellRecord cell = make_attributed_cell("mine", 0.04, {0.0, 0.75, -0.25, 0.5});
  cell.attribution.numeric = {};
  EXPECT_EQ(records::describe_shares(*records::list_shares(cell)),
            "numeric and estimator 75 %, discretisation -25 %, model 50 %; parts below 0 offset the others");
}

TEST(ErrorParts, SharesBelowZeroOrAboveHundred_AreExplained_OthersAreNot) {
  for (const auto& shares : {records::PartShares{0.0, 1.03, -0.03, 0.0}, {-0.004, -0.004, 1.008, 0.0}})
    EXPECT_THAT(records::describe_shares(shares), EndsWith("; parts below 0 offset the others"));
  EXPECT_EQ(records::describe_shares({0.0, 0.0, 1.004, -0.004}),
            "numeric 0 %, estimator 0 %, discretisation 100 %, model 0 %");
}

}  // namespace
}  // namespace shadowbench::records
