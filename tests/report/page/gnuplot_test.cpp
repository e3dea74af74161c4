#include "report/page/gnuplot.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "filters/base/error.h"
#include "report/files/atomic_file.h"
#include "report/page/plot_files.h"
#include "report/page/plot_style.h"
#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::page {

using namespace analysis;
using namespace records;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Plot make_plot(const std::string& title) {
  Plot plot{"plots/a.svg", title, "cost ’x’", "error <y> & more", {}, {}, {}, {"1: none"}};
  plot.series.push_back({"it's `date` \"q\" \\n",
                         "#0072b2",
                         7,
                         PlotLine::kSteps,
                         true,
                         {{{1.0, 0.5, 2.0}, {0.5, 0.4, 0.6}, "7"}, {{2.0, 2.0, 2.0}, {0.25, 0.25, 0.25}}}});
  plot.x = choose_axis({1.0, 2.0}, {}, TickKind::kNumber);
  plot.y = choose_axis({0.25, 0.5}, {}, TickKind::kNumber);
  return plot;
}

bool has_text(const std::string& svg, const std::string& text) { return svg.find(text) != std::string::npos; }

std::string draw(const TemporaryFolder& folder, const std::vector<Plot>& plots) {
  files::write_text_file(folder.path() / "plots" / "plots.gp", make_gnuplot_script(plots));
  EXPECT_EQ(run_gnuplot(folder.path(), "plots/plots.gp"), std::nullopt);
  return read_text(folder.path() / plots[0].file);
}

TEST(Gnuplot, Svg_HoldsTheTexts) {
  const TemporaryFolder folder("gnuplot_texts");
  const std::string svg = draw(folder, {make_plot("a title")});
  for (const char* text : {"a title", "cost ’x’", "error &lt;y> &amp; more", "it’s `date`", "1: none"})
    EXPECT_TRUE(has_text(svg, text)) << text;
  EXPECT_TRUE(has_text(svg, "</svg>"));
}

TEST(Gnuplot, HostileTexts_AreTexts) {
  const TemporaryFolder folder("gnuplot_hostile");
  const std::string svg = draw(
      folder,
      {make_plot(
          "'; set output 'plots/evil.svg'; system('touch evil')\nsystem('touch evil') #{/Bold x}_2</svg><script>")});
  EXPECT_TRUE(has_text(svg, "#{/Bold x}_2&lt;/svg>&lt;script>"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "evil"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "plots" / "evil.svg"));
}

TEST(Gnuplot, WhereItFails_TheReasonIsGiven) {
  const TemporaryFolder folder("gnuplot_fails");
  files::write_text_file(folder.path() / "bad.gp", "plot nonsense(\n");
  EXPECT_THAT(run_gnuplot(folder.path(), "bad.gp").value_or(""), HasSubstr("gnuplot failed"));
  files::write_text_file(folder.path() / "slow.gp", "pause 30\n");
  EXPECT_THAT(run_gnuplot(folder.path(), "slow.gp", 0.2).value_or(""), HasSubstr("longer than 0.2 s"));
}

// A limit on file sizes stands for a full disk: the script fits, the drawing does not, and gnuplot does not say so.
TEST(Gnuplot, FullDisk_IsAnOutputError_AndNoPlotIsLeft) {
  const TemporaryFolder folder("gnuplot_full");
  const std::vector<Plot> plots = {make_plot("a title")};
  ASSERT_LT(make_gnuplot_script(plots).size(), 4096u);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message = "no error";
  try {
    write_plot_files(folder.path(), "plots/plots.gp", plots);
  } catch (const Error& error) {
    message = error.kind() == ErrorKind::kOutput ? error.what() : "another error";
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, testing::AllOf(HasSubstr((folder.path() / "plots" / "a.svg").string()), HasSubstr("free space"),
                                      HasSubstr("--out")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "plots" / "a.svg"));
  write_plot_files(folder.path(), "plots/plots.gp", plots);
  EXPECT_TRUE(has_text(read_text(folder.path() / "plots" / "a.svg"), "</svg>"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "a folder that plots are drawn in stays";
}

TEST(Gnuplot, WhereItIsMissing_ThatIsSaid) {
  const TemporaryFolder folder("gnuplot_missing");
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const auto reason = run_gnuplot(folder.path(), "a.gp");
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(reason.value_or(""), HasSubstr("install gnuplot-nox"));
}

}  // namespace
}  // namespace shadowbench::page
