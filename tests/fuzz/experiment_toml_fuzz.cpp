// An experiment file: its settings, and its swept filters written out in full.

#include "filters/catalogue.h"
#include "harness/options/experiment_file.h"
#include "tests/fuzz/input.h"

void shadowbench::fuzz::try_input(std::string_view text) {
  static const filters::Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  const options::Experiment experiment = options::read_experiment(write_input("input.toml", text));
  options::expand_filters(experiment, catalogue);
}
