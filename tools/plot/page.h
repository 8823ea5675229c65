/* page.h - a self-contained HTML page: sections, sortable tables, charts, the commands that made it.
 *
 * It is one file that opens offline: style, script and pictures are inside, and nothing is fetched. Sorting takes a
 * dozen lines of script at the end; without script the tables keep the order in which they were written.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/plot/chart.h"

namespace tandem {

/* One cell: its text, and the number by which it is sorted, if there is one. */
struct PageCell {
  PageCell(std::string words) : text(std::move(words)) {}
  PageCell(const char *words) : text(words) {}
  PageCell(double number); /* four digits; "-" if it is not finite */
  PageCell(std::string words, double number) : text(std::move(words)), value(number) {}

  std::string text;
  std::optional<double> value = std::nullopt;
  std::string mark; /* a class: "good", "bad" or none */
};

struct PageTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<PageCell>> rows = {};
};

class Page {
public:
  /* `introduction` and all paragraphs are plain text, which is escaped; html() is not escaped. */
  Page(std::string title, std::string introduction);

  void section(const std::string &title);    /* level 2, listed in the contents */
  void subsection(const std::string &title); /* level 3 */
  void paragraph(const std::string &text, const std::string &style_class = "");
  void chart(const Chart &chart);
  void table(const PageTable &table);
  void commands(const std::vector<std::string> &lines); /* in the form of a command line, in one block */
  void html(const std::string &markup);                 /* not escaped: an image as data:, a picture as SVG */

  std::string text() const;

private:
  std::string title_, introduction_, contents_, body_;
  int sections_ = 0;
};

} // namespace tandem
