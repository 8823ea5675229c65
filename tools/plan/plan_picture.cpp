/* plan_picture.cpp - lays out the boxes of two plans and writes them as SVG; see plan_picture.h. */
#include "tools/plan/plan_picture.h"

#include <algorithm>

#include <fmt/format.h>

#include "tools/plot/chart.h"
#include "tools/plot/markup.h"

namespace tandem {
namespace {

constexpr double width = 1200, margin = 20, gap = 24, column_width = (width - 2 * margin - gap) / 2; /* px */
constexpr double box_height = 30, box_gap = 4, box_padding = 6, heading = 26, after_stage = 10, head = 84,
                 summary_at = 110;
constexpr double letter = 6.5; /* mean width of a letter of the boxes' font */

/* Where a box stands in its column. */
struct Place {
  double x, y, width;
};

size_t letters_of(const PlanBox &box) { return std::max(box.name.size(), box.note.size()); }

using Boxes = std::vector<PlanBox>;

/* Boxes of both columns have the width of the longer text, and fill rows as words do. Returns where the next row is. */
double lay_out(const Boxes &one, const Boxes &other, double y, std::vector<Place> &places)
{
  double x = 0;
  for (size_t i = 0; i < one.size(); ++i) {
    const auto letters = static_cast<double>(std::max(letters_of(one[i]), letters_of(other[i])));
    const double wide = 2 * box_padding + letter * letters;
    if (x > 0 && x + wide > column_width) x = 0, y += box_height + box_gap;
    places.push_back({x, y, wide});
    x += wide + box_gap;
  }
  return one.empty() ? y : y + box_height + box_gap;
}

std::string style_of(const PlanBox &box)
{
  if (!box.kept) return "fill=\"#eeeeee\" stroke=\"#dddddd\"";
  if (!box.color) return "fill=\"#ffffff\" stroke=\"#444444\"";
  return fmt::format("fill=\"{}\" fill-opacity=\"0.3\" stroke=\"{}\"", series_color(*box.color),
                     series_color(*box.color));
}

std::string text_of(const PlanBox &box, const Place &place, double left)
{
  const char *const ink = box.kept ? "#111111" : "#767676";
  const double x = left + place.x;
  return fmt::format(
      "<g><title>{}</title><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.0f}\" rx=\"3\" {}/>"
      "<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text><text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\" "
      "font-size=\"9.5\">{}</text></g>\n",
      escaped(box.meaning), x, place.y, place.width, box_height, style_of(box), x + box_padding, place.y + 13, ink,
      escaped(box.name), x + box_padding, place.y + 25, ink, escaped(box.note));
}

std::string boxes_of(const Boxes &boxes, const std::vector<Place> &places, double left)
{
  std::string text;
  for (size_t i = 0; i < boxes.size(); ++i) text += text_of(boxes[i], places[i], left);
  return text;
}

std::string words(double x, double y, double size, const std::string &text, const char *more = "")
{
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" fill=\"#111111\" {}>{}</text>\n", x, y, size,
                     more, escaped(text));
}

std::string bold(double x, double y, double size, const std::string &text)
{
  return words(x, y, size, text, "font-weight=\"bold\"");
}

std::string heading_of(const PlanStage &stage, double left, double y)
{
  return bold(left, y, 13, stage.name) + words(left + summary_at, y, 11, stage.summary);
}

} // namespace

std::string svg_of(const std::string &title, const std::array<PlanColumn, 2> &columns)
{
  std::string body = bold(margin, 28, 17, title);
  double y = head;
  const std::array<double, 2> left = {margin, margin + column_width + gap};
  for (size_t c = 0; c < 2; ++c)
    body += bold(left[c], 54, 14, columns[c].title) + words(left[c], 72, 11, columns[c].summary);
  for (size_t s = 0; s < columns[0].stages.size(); ++s) {
    const PlanStage &one = columns[0].stages[s], &other = columns[1].stages[s];
    std::vector<Place> kernels, buffers;
    const double middle = lay_out(one.kernels, other.kernels, y + heading, kernels);
    const double end = lay_out(one.buffers, other.buffers, middle, buffers);
    for (size_t c = 0; c < 2; ++c)
      body += heading_of(columns[c].stages[s], left[c], y + heading - 8) +
              boxes_of(columns[c].stages[s].kernels, kernels, left[c]) +
              boxes_of(columns[c].stages[s].buffers, buffers, left[c]);
    y = end + after_stage;
  }
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
                     "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" "
                     "font-size=\"10.5\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" "
                     "fill=\"#ffffff\"/>\n{3}</svg>\n",
                     width, y + margin, escaped(title), body);
}

} // namespace tandem
