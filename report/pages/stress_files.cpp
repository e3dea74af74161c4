#include "report/pages/stress_files.h"

#include "report/files/atomic_file.h"
#include "report/page/plot_files.h"
#include "report/pages/stress_plots.h"
#include "report/pages/stress_text.h"
#include "report/records/stress_json.h"

namespace shadowbench::pages {

void write_stress_files(const std::filesystem::path& dir, records::StressRecord& record) {
  std::vector<page::Plot> plots;
  for (const records::StressAxis& axis : record.axes)
    if (has_plot(axis)) plots.push_back(make_stress_plot(axis));
  record.no_plots = page::write_plot_files(dir, "stress.gp", plots).value_or("");
  files::write_text_file(dir / "stress.json", records::make_stress_json(record));
  files::write_text_file(dir / "stress.csv", records::make_stress_csv(record));
  files::write_text_file(dir / "stress.md", make_stress_text(record));
  files::write_text_file(dir / "stress.html", make_stress_html(record));
}

}  // namespace shadowbench::pages
