#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace shadowbench::filters {

/// A filter whose file cannot be used, and why.
struct FilterMistake {
  std::string id;
  std::string file;
  std::string message;  ///< with file and line
};

/// All the filters of a run that cannot be used.
class FilterErrors : public Error {
 public:
  /// Requires one mistake at least.
  explicit FilterErrors(std::vector<FilterMistake> mistakes)
      : Error(ErrorKind::kFilter, describe(mistakes)), mistakes_(std::move(mistakes)) {}

  const std::vector<FilterMistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<FilterMistake> mistakes_;

  static std::string describe(const std::vector<FilterMistake>& mistakes) {
    if (mistakes.size() == 1) return mistakes.front().message;
    std::string text = fmt::format("{} filters have mistakes", mistakes.size());
    for (const FilterMistake& mistake : mistakes) text += "\n" + mistake.message;
    return text;
  }
};

}  // namespace shadowbench::filters
