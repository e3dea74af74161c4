#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// What made a record: program, machine, OpenGL and command line.
struct Provenance {
  std::string commit;
  GlRecord gl;
  MachineRecord machine;
  std::uint64_t seed = 0;
  std::vector<std::string> command;  ///< one entry per argument
  double seconds = 0.0;              ///< wall time
};

/// Writes the fields that stress.json and flicker.json begin with.
nlohmann::json to_json(const Provenance& provenance, int schema_version);

}  // namespace shadowbench::records
