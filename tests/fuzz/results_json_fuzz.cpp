// A results.json. What was read is written and read again: it must then be the same.

#include <nlohmann/json.hpp>

#include "report/json_io.h"
#include "report/json_values.h"
#include "tests/fuzz/scratch_folder.h"

namespace shadowbench::fuzz {
namespace {

void require_same(const nlohmann::json& first, const nlohmann::json& second) {
  if (report::dump_line(first) != report::dump_line(second)) std::abort();
}

void read_results(std::string_view text) {
  static const ScratchFolder folder;
  const report::Results results = report::read_results(folder.write("results.json", text));
  const nlohmann::json run = report::to_json(results.run);
  require_same(run, report::to_json(report::run_from_json(run, "written")));
  for (const report::CellRecord& cell : results.cells) {
    const nlohmann::json written = report::to_json(cell);
    require_same(written, report::to_json(report::cell_from_json(written, "written")));
  }
}

}  // namespace
}  // namespace shadowbench::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shadowbench::fuzz;
  allow_refusal([&] { read_results(as_text(data, size)); });
  return 0;
}
