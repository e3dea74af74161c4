#include "report/records/filter_mistakes.h"

#include <fstream>

#include "base/files.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

std::filesystem::path file_in(const std::filesystem::path& folder) { return folder / "filter_mistakes.json"; }

}  // namespace

void write_filter_mistakes(const std::filesystem::path& folder, const std::vector<filters::FilterMistake>& mistakes) {
  std::error_code ignored;
  if (mistakes.empty()) {
    std::filesystem::remove(file_in(folder), ignored);
    return;
  }
  nlohmann::json list = nlohmann::json::array();
  for (const filters::FilterMistake& each : mistakes)
    list.push_back({{"filter", each.id}, {"file", each.file}, {"message", each.message}});
  write_text_file(file_in(folder), dump_file(list));
}

std::vector<filters::FilterMistake> read_filter_mistakes(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(file_in(folder), ignored)) return {};
  require_plain_file(file_in(folder), kMebibyte);
  std::vector<filters::FilterMistake> mistakes;
  try {
    std::ifstream stream(file_in(folder), std::ios::binary);
    const nlohmann::json list = parse_json(stream);
    for (const nlohmann::json& each : list)
      mistakes.push_back({each.at("filter").get<std::string>(), each.at("file").get<std::string>(),
                          each.at("message").get<std::string>()});
  } catch (const std::exception&) {
    fail_input("this file is damaged; run again, or remove it", file_in(folder).string());
  }
  return mistakes;
}

}  // namespace shadowbench::records
