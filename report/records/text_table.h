#pragma once

#include <string>
#include <vector>

namespace shadowbench::records {

/// A table's texts.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

}  // namespace shadowbench::records
