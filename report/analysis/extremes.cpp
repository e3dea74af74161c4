#include "report/analysis/extremes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace shadowbench::analysis {
namespace {

constexpr std::size_t kMostNamed = 3;

}  // namespace

std::string list_some(const std::vector<std::string>& names) {
  if (names.size() <= kMostNamed) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + kMostNamed, ", "),
                     names.size() - kMostNamed);
}

std::string describe_extremes(const std::vector<Rated>& all, const char* link, const char* kind) {
  const auto describe = [&](const Rated& end) {
    std::vector<std::string> names;
    for (const Rated& each : all)
      if (each.text == end.text) names.push_back(each.name);
    const bool are_all = names.size() == all.size() && names.size() > kMostNamed;
    return fmt::format("{} {} {}{}", end.text, link,
                       are_all ? fmt::format("all {} {}", names.size(), kind) : list_some(names),
                       names.size() > 1 ? ", which tie" : "");
  };
  const auto [least, most] = std::ranges::minmax_element(all, {}, &Rated::rate);
  if (least->text == most->text) return describe(*least);
  const std::string begin = describe(*least);
  return fmt::format("from {}{} to {}", begin, begin.ends_with("tie") ? "," : "", describe(*most));
}

}  // namespace shadowbench::analysis
