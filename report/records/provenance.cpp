#include "report/records/provenance.h"

#include <nlohmann/json.hpp>

#include "report/records/json_io.h"

namespace shadowbench::records {

nlohmann::json to_json(const Provenance& provenance, int schema_version) {
  RunRecord run;
  run.gl = provenance.gl;
  run.machine = provenance.machine;
  const nlohmann::json head = to_json(run);
  return {{"schema_version", schema_version}, {"commit", provenance.commit}, {"gl", head.at("gl")},
          {"machine", head.at("machine")},    {"seed", provenance.seed},     {"command", provenance.command},
          {"seconds", provenance.seconds}};
}

}  // namespace shadowbench::records
