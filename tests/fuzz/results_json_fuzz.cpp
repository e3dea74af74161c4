// A results.json. What was read is written and read again: it must then be the same.

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "report/records/json_io.h"
#include "report/records/json_values.h"
#include "tests/fuzz/input.h"

namespace {

void require_same(const nlohmann::json& first, const nlohmann::json& second) {
  if (shadowbench::records::dump_line(first) != shadowbench::records::dump_line(second)) std::abort();
}

}  // namespace

void shadowbench::fuzz::try_input(std::string_view text) {
  const records::Results results = records::read_results(write_input("results.json", text));
  const nlohmann::json run = records::to_json(results.run);
  require_same(run, records::to_json(records::run_from_json(run, "written")));
  for (const records::CellRecord& cell : results.cells) {
    const nlohmann::json written = records::to_json(cell);
    require_same(written, records::to_json(records::cell_from_json(written, "written")));
  }
}
