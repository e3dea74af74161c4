// An experiment file: its settings, and its swept filters written out in full.

#include "filters/catalogue.h"
#include "harness/options/experiment_file.h"
#include "tests/fuzz/input.h"

namespace shadowbench::fuzz {
namespace {

void read_experiment(std::string_view text) {
  static const filters::Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  const options::Experiment experiment = options::read_experiment(write_input("input.toml", text));
  options::expand_filters(experiment, catalogue);
}

}  // namespace
}  // namespace shadowbench::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shadowbench::fuzz;
  allow_refusal([&] { read_experiment(as_text(data, size)); });
  return 0;
}
