// A results.json. What was read is written and read again: it must then be the same.

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "report/records/json_io.h"
#include "report/records/json_values.h"
#include "tests/fuzz/input.h"

namespace shadowbench::fuzz {
namespace {

void require_same(const nlohmann::json& first, const nlohmann::json& second) {
  if (records::dump_line(first) != records::dump_line(second)) std::abort();
}

void read_results(std::string_view text) {
  const records::Results results = records::read_results(write_input("results.json", text));
  const nlohmann::json run = records::to_json(results.run);
  require_same(run, records::to_json(records::run_from_json(run, "written")));
  for (const records::CellRecord& cell : results.cells) {
    const nlohmann::json written = records::to_json(cell);
    require_same(written, records::to_json(records::cell_from_json(written, "written")));
  }
}

}  // namespace
}  // namespace shadowbench::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shadowbench::fuzz;
  allow_refusal([&] { read_results(as_text(data, size)); });
  return 0;
}
