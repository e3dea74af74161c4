#include "report/analysis/front_words.h"

#include <fmt/format.h>

#include "filters/kernel_width.h"
#include "report/analysis/trade_measures.h"

namespace shadowbench::analysis {

std::vector<std::string> explain_fronts(const std::vector<Measure>& costs) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Only filters whose kernels are about equally wide are compared: a wider kernel makes a softer shadow, "
          "and is no worse filter. A kernel's width is its standard deviation along an axis, in texels; each "
          "class has a front of its own: {}.",
          filters::describe_classes()),
      "A cell of the front beats another of its class, which is then dominated, where it costs no more, its error is "
      "not clearly larger, and one of the two is clearly less. A cell is tied with one of the front where neither is "
      "clearly less. Clearly: errors that differ by more than half the wider 95 % interval over the phases of the "
      "map's "
      "grid, times whose 95 % intervals do not overlap, everything else where the numbers differ. Of several that beat "
      "a "
      "cell, the cheapest is named."};
  for (const Measure& measure : list_error_measures()) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.name, measure.meaning, measure.over_scenes));
  }
  for (const Measure& measure : costs) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.name, measure.meaning, measure.over_scenes));
  }
  return sentences;
}

}  // namespace shadowbench::analysis
