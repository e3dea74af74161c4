#include "report/pages/flicker_files.h"

#include "report/files/atomic_file.h"
#include "report/page/plot_files.h"
#include "report/pages/flicker_plots.h"
#include "report/pages/flicker_text.h"
#include "report/records/flicker_json.h"

namespace shadowbench::pages {

void write_flicker_files(const std::filesystem::path& dir, records::FlickerRecord& record) {
  std::vector<page::Plot> plots;
  for (const records::FlickerMotion& motion : record.motions)
    for (const records::FlickerVariant& variant : motion.variants) plots.push_back(make_flicker_plot(motion, variant));
  record.no_plots = page::write_plot_files(dir, "flicker.gp", plots).value_or("");
  files::write_text_file(dir / "flicker.json", records::make_flicker_json(record));
  files::write_text_file(dir / "flicker.csv", records::make_flicker_csv(record));
  files::write_text_file(dir / "flicker.md", make_flicker_text(record));
  files::write_text_file(dir / "flicker.html", make_flicker_html(record));
}

}  // namespace shadowbench::pages
