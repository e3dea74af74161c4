#include "report/pages/column_list.h"

namespace shadowbench::pages {

page::Details explain_columns(const std::string& file, const std::vector<records::CsvColumn>& columns) {
  page::Facts facts;
  for (const records::CsvColumn& column : columns) facts.items.push_back({column.name, column.meaning});
  return {"Columns of " + file, {facts}};
}

}  // namespace shadowbench::pages
