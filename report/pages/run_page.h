#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/bias_record.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Makes the page of a run: the choice of a filter, where errors come from, warnings, the table of all numbers, the
/// viewer, the trade; folded away the tables of each scene, what is absent and why, the columns of the CSV files, and
/// the machine. `cells` have no times where several kinds of machine measured them: withhold_mixed_times().
/// `biases` are what a sweep of the bias recommends. A run under way says on top how far it is, `so_far`, and has no
/// data files to link to.
document::Page make_run_page(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                             const std::vector<records::BiasCell>& biases = {}, const std::string& so_far = {});

}  // namespace shadowbench::pages
