#include "report/records/flicker_record.h"

#include <fmt/format.h>

#include "report/records/csv_tables.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::records {

void visit_fields(const FlickerFilter& filter, auto&& visit) {
  visit("filter", filter.filter);
  visit("change", filter.change);
  visit("flicker", filter.flicker);
  visit("back_and_forth", filter.returning);
  visit("not_finite", filter.not_finite);
  visit("step_change", filter.step_change);
}

void visit_fields(const FlickerTruth& truth, auto&& visit) {
  visit("traced", truth.moves);
  visit("change", truth.change);
  visit("back_and_forth", truth.returning);
  visit("standard_error_of_change", truth.noise);
  visit("step_change", truth.step_change);
}

void visit_fields(const FlickerVariant& variant, auto&& visit) {
  visit("snap", variant.snap);
  visit("texel_m", variant.texel_m);
  visit("grid_texels", variant.grid_texels);
  visit("resizes", variant.resizes);
  visit("filters", variant.filters);
}

void visit_fields(const FlickerMotion& motion, auto&& visit) {
  visit("id", motion.id);
  visit("title", motion.title);
  visit("step", motion.step);
  visit("step_unit", motion.step_unit);
  visit("fit", motion.fit);
  visit("receivers", motion.receivers);
  visit("truth", motion.truth);
  visit("variants", motion.variants);
  visit("picture", motion.picture);
}

std::string make_flicker_json(const FlickerRecord& record) {
  nlohmann::json written = to_json(record, kFlickerSchemaVersion);
  written["scene"] = record.scene;
  written["view"] = record.view;
  written["size"] = {record.width, record.height};
  written["map_size"] = record.map_size;
  written["frames"] = record.frames;
  written["back_and_forth_above"] = static_cast<double>(record.return_above);
  written["motions"] = value_json(record.motions);
  return dump_file(written);
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
