#include "report/flicker_files.h"

#include "report/atomic_file.h"
#include "report/flicker_json.h"
#include "report/flicker_plots.h"
#include "report/flicker_text.h"
#include "report/plot_files.h"

namespace shadowbench::report {

void write_flicker_files(const std::filesystem::path& dir, FlickerRecord& record) {
  std::vector<Plot> plots;
  for (const FlickerMotion& motion : record.motions)
    for (const FlickerVariant& variant : motion.variants) plots.push_back(make_flicker_plot(motion, variant));
  record.no_plots = write_plot_files(dir, "flicker.gp", plots).value_or("");
  write_text_file(dir / "flicker.json", make_flicker_json(record));
  write_text_file(dir / "flicker.csv", make_flicker_csv(record));
  write_text_file(dir / "flicker.md", make_flicker_text(record));
  write_text_file(dir / "flicker.html", make_flicker_html(record));
}

}  // namespace shadowbench::report
