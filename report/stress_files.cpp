#include "report/stress_files.h"

#include "report/atomic_file.h"
#include "report/plot_files.h"
#include "report/stress_json.h"
#include "report/stress_plots.h"
#include "report/stress_text.h"

namespace shadowbench::report {

void write_stress_files(const std::filesystem::path& dir, StressRecord& record) {
  std::vector<Plot> plots;
  for (const StressAxis& axis : record.axes)
    if (has_plot(axis)) plots.push_back(make_stress_plot(axis));
  record.no_plots = write_plot_files(dir, "stress.gp", plots).value_or("");
  write_text_file(dir / "stress.json", make_stress_json(record));
  write_text_file(dir / "stress.csv", make_stress_csv(record));
  write_text_file(dir / "stress.md", make_stress_text(record));
  write_text_file(dir / "stress.html", make_stress_html(record));
}

}  // namespace shadowbench::report
