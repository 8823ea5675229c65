/* page.cpp - writes the HTML, style and script of a page; see page.h. */
#include "tools/plot/page.h"

#include <cmath>

#include <fmt/format.h>

#include "tools/plot/markup.h"

namespace tandem {
namespace {

constexpr const char *page_style = R"(
  :root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2530; --faint: #eef1f5; --rule: #c5ccd6;
          --good: #00694d; --bad: #b34a00; }
  @media (prefers-color-scheme: dark) {
    :root { --paper: #14181e; --ink: #dfe5ec; --faint: #1f252d; --rule: #3a4350; --good: #4cc9a1; --bad: #ff9350; }
  }
  body { background: var(--paper); color: var(--ink); font: 15px/1.45 system-ui, sans-serif; max-width: 1000px;
         margin: 2rem auto; padding: 0 1rem; }
  h1 { font-size: 1.7rem; } h3 { font-size: 1.05rem; }
  h2 { font-size: 1.3rem; margin-top: 2.4rem; border-bottom: 1px solid var(--rule); }
  nav { columns: 3; font-size: 14px; margin: 1rem 0; } nav a { display: block; color: inherit; }
  pre { background: var(--faint); padding: .7rem .9rem; overflow-x: auto; font-size: 13px; }
  .pick { font-weight: 600; }
  .table { overflow-x: auto; margin: 1rem 0; max-height: 34rem; }
  table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
  caption { text-align: left; padding-bottom: .3rem; opacity: .8; }
  th, td { padding: .2rem .7rem; border-bottom: 1px solid var(--rule); text-align: left; white-space: nowrap; }
  td.number { text-align: right; } td.good { color: var(--good); } td.bad { color: var(--bad); }
  th { position: sticky; top: 0; background: var(--faint); cursor: pointer; user-select: none; }
  th[aria-sort=ascending]::after { content: " \25b2"; } th[aria-sort=descending]::after { content: " \25bc"; }
)";

/* Numbers by value, text by letters; what has no value stays last in both directions. */
constexpr const char *script = R"(
  function sortTable(head) {
    const table = head.closest('table'), column = [...head.parentNode.children].indexOf(head);
    const down = head.getAttribute('aria-sort') === 'ascending', sign = down ? -1 : 1;
    for (const other of head.parentNode.children) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const numeric = [...table.tBodies[0].rows].some(row => row.cells[column].dataset.value !== undefined);
    const compare = (a, b) => {
      const [x, y] = [a.cells[column], b.cells[column]];
      if (!numeric) return sign * x.textContent.localeCompare(y.textContent);
      const [u, v] = [parseFloat(x.dataset.value), parseFloat(y.dataset.value)];
      return isNaN(u) || isNaN(v) ? isNaN(u) - isNaN(v) : sign * (u - v);
    };
    table.tBodies[0].append(...[...table.tBodies[0].rows].sort(compare));
  }
  for (const head of document.querySelectorAll('th')) {
    head.onclick = () => sortTable(head);
    head.onkeydown = event => { if (event.key === 'Enter') sortTable(head); };
  }
  /* ?sort=TABLE.COLUMN, counted from 0: a link to a sorted page */
  const asked = new URLSearchParams(location.search).getAll('sort');
  for (const place of asked) {
    const [table, column] = place.split('.').map(Number);
    const heads = document.querySelectorAll('table')[table]?.querySelectorAll('th');
    if (heads?.[column]) sortTable(heads[column]);
  }
)";

std::string cell_text(const PageCell &cell)
{
  std::string classes = cell.value ? "number" : "";
  if (!cell.mark.empty()) classes += (classes.empty() ? "" : " ") + cell.mark;
  return fmt::format("<td{}{}>{}</td>", classes.empty() ? "" : fmt::format(" class=\"{}\"", classes),
                     cell.value ? fmt::format(" data-value=\"{:.17g}\"", *cell.value) : "", escaped(cell.text));
}

} // namespace

PageCell::PageCell(double number) : text(std::isfinite(number) ? fmt::format("{:.4g}", number) : "-"), value(number) {}

Page::Page(std::string title, std::string introduction)
    : title_(std::move(title)), introduction_(std::move(introduction))
{}

void Page::section(const std::string &title)
{
  ++sections_;
  contents_ += fmt::format("<a href=\"#s{}\">{}</a>\n", sections_, escaped(title));
  body_ += fmt::format("<h2 id=\"s{}\">{}</h2>\n", sections_, escaped(title));
}

void Page::subsection(const std::string &title) { body_ += fmt::format("<h3>{}</h3>\n", escaped(title)); }

void Page::paragraph(const std::string &text, const std::string &style_class)
{
  body_ +=
      fmt::format("<p{}>{}</p>\n", style_class.empty() ? "" : fmt::format(" class=\"{}\"", style_class), escaped(text));
}

void Page::chart(const Chart &chart) { body_ += "<figure style=\"margin:1rem 0\">\n" + svg_of(chart) + "</figure>\n"; }

void Page::table(const PageTable &table)
{
  body_ += "<div class=\"table\"><table>\n";
  if (!table.caption.empty()) body_ += fmt::format("<caption>{}</caption>\n", escaped(table.caption));
  body_ += "<thead><tr>";
  for (const std::string &title : table.header)
    body_ += fmt::format("<th tabindex=\"0\" title=\"sort\">{}</th>", escaped(title));
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto &row : table.rows) {
    body_ += "<tr>";
    for (const PageCell &cell : row) body_ += cell_text(cell);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::commands(const std::vector<std::string> &lines)
{
  body_ += "<pre>";
  for (const std::string &line : lines) body_ += escaped(line) + "\n";
  body_ += "</pre>\n";
}

void Page::html(const std::string &markup) { body_ += markup; }

std::string Page::text() const
{
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title_) + "</title>\n<style>" + page_style + "</style>\n</head>\n<body>\n<h1>" + escaped(title_) +
         "</h1>\n<p>" + escaped(introduction_) + "</p>\n<nav>\n" + contents_ + "</nav>\n" + body_ + "<script>" +
         script + "</script>\n</body>\n</html>\n";
}

} // namespace tandem
