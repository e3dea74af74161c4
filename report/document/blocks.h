#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "report/document/chart.h"
#include "report/records/csv_tables.h"

namespace shadowbench::document {

// A page is a list of sections, and a section is a list of blocks. The HTML writer and the Markdown writer know every
// kind of block and escape every text; whoever makes a page writes neither HTML nor Markdown. Paths are relative to the
// page.

/// Names with what each is, such as the machine and the map.
struct Facts {
  std::vector<std::pair<std::string, std::string>> items;
};

/// A list of sentences, after a lead that may be empty.
struct Sentences {
  std::string lead;
  std::vector<std::string> items;
};

/// A paragraph; a quiet one explains and is printed smaller.
struct Paragraph {
  std::string text;
  bool quiet = false;
};

/// A heading within a section.
struct Heading {
  std::string text;
};

/// A file of the report, or another page, by its path.
struct Link {
  std::string path;
  std::string text;
};

/// Links in one line, after a lead.
struct Links {
  std::string lead;
  std::vector<Link> items;
};

/// What the text of a cell means: far from a limit, near to it, or beyond it.
enum class Grade { kNone, kGood, kNear, kBad };

/// A table with its caption. Numbers are aligned by the writers, and cells coloured by their grade.
struct Table {
  std::string caption;
  records::TextTable table;
  std::vector<std::vector<Grade>> grades = {};  ///< of rows and columns; what it lacks is kNone

  /// Says something of the thing that a row is named for, under a filter; either is added where it is new. What was
  /// said first stays.
  void judge(const std::string& thing, const std::string& filter, std::string text, Grade grade);

  Grade grade_at(std::size_t row, std::size_t column) const;

  /// What a cell shows: its text, after a mark where it is beyond a limit.
  std::string text_at(std::size_t row, std::size_t column) const;
};

/// A picture file with its caption, which is its description for those who cannot see it.
struct Picture {
  std::string path;
  std::string caption;
};

/// Pictures beside each other that can be folded away; without a title one picture over the whole width.
struct Gallery {
  std::string title;
  std::vector<Picture> pictures;
  bool wide = false;  ///< fewer beside each other
};

/// Stacked bars with signed segments on a common scale, one row for each thing compared.
struct Bars {
  struct Segment {
    double begin = 0.0;  ///< on the scale
    double end = 0.0;
    std::string color;  ///< "#rrggbb"
  };
  struct Row {
    std::string label;
    std::vector<Segment> segments;
    double net = 0.0;        ///< where a tick marks the sum
    std::string words = {};  ///< the segments in words, for who cannot see them; shown under a pointer
  };
  std::string title;
  std::vector<std::pair<std::string, std::string>> legend;  ///< colour and what it stands for
  double low = 0.0;                                         ///< of the scale
  double high = 1.0;
  std::vector<Row> rows;
};

struct Details;
struct Mount;

/// Everything that a page is made of.
using Block =
    std::variant<Facts, Sentences, Paragraph, Heading, Links, Table, Gallery, Bars, Chart, ChartChoice, Details, Mount>;

/// Blocks that the reader unfolds.
struct Details {
  std::string summary;
  std::vector<Block> blocks;
};

/// A place that a script of the page fills from its data. The blocks stand there until then, without scripts, and in
/// Markdown.
struct Mount {
  std::string name;  ///< "answer", "table", "viewer"
  std::vector<Block> blocks;
};

/// A part of a page with a heading of its own.
struct Section {
  std::string id;       ///< for links to it; letters, digits and '-'
  std::string heading;  ///< empty: none, as at the top of a page
  std::vector<Block> blocks;
  bool warns = false;  ///< printed so that it is not overlooked
  bool brief = false;  ///< its unfolded blocks are in the page's summary, too
};

/// A page: <stem>.html and <stem>.md say the same.
struct Page {
  std::string title;
  std::vector<Section> sections;
  std::vector<Link> siblings = {};  ///< the program's other pages that lie beside this one
  std::string of = {};              ///< what it is about, in the browser's tab after the title
  nlohmann::json data = {};         ///< what the scripts that fill mounts read; null: there are none
};

/// Writes a page as HTML that opens from disk and loads nothing but what lies beside it, in `dir`: pictures that are
/// there already have their sizes in it.
std::string write_html(const Page& page, const std::filesystem::path& dir = {});

/// Links a page that write_html() wrote with other siblings than it had when it was written.
std::string replace_siblings(std::string html, const std::vector<Link>& siblings);

/// Writes a page as Markdown. Only the HTML page draws charts; Markdown says which.
std::string write_markdown(const Page& page);

}  // namespace shadowbench::document
