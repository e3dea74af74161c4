#include "report/records/flicker_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/records/csv.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

json to_json(const FlickerFilter& filter) {
  return {{"filter", filter.filter},         {"change", filter.change},
          {"flicker", filter.flicker},       {"back_and_forth", filter.returning},
          {"not_finite", filter.not_finite}, {"step_change", filter.step_change}};
}

json to_json(const FlickerTruth& truth) {
  return {{"traced", truth.moves},
          {"change", truth.change},
          {"back_and_forth", truth.returning},
          {"standard_error_of_change", truth.noise},
          {"step_change", truth.step_change}};
}

json to_json(const FlickerVariant& variant) {
  return {{"snap", variant.snap},
          {"texel_m", variant.texel_m},
          {"grid_texels", variant.grid_texels},
          {"resizes", variant.resizes},
          {"filters", list_json(variant.filters, to_json)}};
}

json to_json(const FlickerMotion& motion) {
  return {{"id", motion.id},
          {"title", motion.title},
          {"step", motion.step},
          {"step_unit", motion.step_unit},
          {"fit", motion.fit},
          {"receivers", motion.receivers},
          {"truth", to_json(motion.truth)},
          {"variants", list_json(motion.variants, to_json)},
          {"picture", motion.picture}};
}

}  // namespace

std::string make_flicker_json(const FlickerRecord& record) {
  json result = to_json(record, kFlickerSchemaVersion);
  result["scene"] = record.scene;
  result["view"] = record.view;
  result["size"] = {record.width, record.height};
  result["map_size"] = record.map_size;
  result["frames"] = record.frames;
  result["back_and_forth_above"] = static_cast<double>(record.return_above);
  result["motions"] = list_json(record.motions, to_json);
  return result.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string make_flicker_csv(const FlickerRecord& record) {
  std::string csv =
      "scene,view,map_size,frames,motion,step,step_unit,snap,filter,receivers,change,truth_change,truth_noise,flicker,"
      "back_and_forth,truth_back_and_forth,not_finite\r\n";
  for (const FlickerMotion& motion : record.motions) {
    for (const FlickerVariant& variant : motion.variants) {
      for (const FlickerFilter& filter : variant.filters) {
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", quote_csv(record.scene),
                           quote_csv(record.view), record.map_size, record.frames, motion.id, motion.step,
                           motion.step_unit, variant.snap ? "on" : "off", quote_csv(filter.filter), motion.receivers,
                           filter.change, motion.truth.change, motion.truth.noise, filter.flicker, filter.returning,
                           motion.truth.returning, filter.not_finite);
      }
    }
  }
  return csv;
}

}  // namespace shadowbench::records
