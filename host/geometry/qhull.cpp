/* qhull.cpp - see qhull.h. Of Qhull's interface only what cannot call its error handler is used after the hull is there: that
 * handler leaves by longjmp, past the destructors of C++. */
#include "host/geometry/qhull.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <new>
#include <utility>

extern "C" {
#include <libqhull_r/libqhull_r.h>
}

namespace tandem {
namespace {

/* What Qhull says goes to memory; of an error the first line is passed on. */
class Messages {
public:
  Messages() : file_(open_memstream(&text_, &size_))
  {
    if (!file_) throw std::bad_alloc();
  }
  ~Messages()
  {
    std::fclose(file_);
    std::free(text_);
  }
  Messages(const Messages &) = delete;
  Messages &operator=(const Messages &) = delete;

  FILE *file() { return file_; }

  std::string first_line()
  {
    std::fflush(file_);
    const std::string text(text_, size_);
    const size_t start = text.find_first_not_of("\n ");
    return start == std::string::npos ? "no reason given" : text.substr(start, text.find('\n', start) - start);
  }

private:
  char *text_ = nullptr;
  size_t size_ = 0;
  FILE *file_;
};

class Qhull {
public:
  explicit Qhull(FILE *messages) { qh_zero(&state_, messages); }
  ~Qhull()
  {
    int long_blocks, long_bytes;
    qh_freeqhull(&state_, !qh_ALL);
    qh_memfreeshort(&state_, &long_blocks, &long_bytes);
  }
  Qhull(const Qhull &) = delete;
  Qhull &operator=(const Qhull &) = delete;

  qhT *state() { return &state_; }

private:
  qhT state_;
};

/* Qhull's own order of corners (qh_facet3vertex) is clockwise seen from outside, hence both orders are turned round here. */

uint32_t index_of(qhT *qh, vertexT *vertex) { return uint32_t((vertex->point - qh->first_point) / 3); }

Polygon triangle(qhT *qh, facetT *facet)
{
  Polygon corners;
  vertexT *vertex, **vertexp;
  FOREACHvertex_(facet->vertices) corners.push_back(index_of(qh, vertex));
  if (bool(facet->toporient) != bool(qh_ORIENTclock)) std::swap(corners[0], corners[1]);
  return corners;
}

/* Merged facets keep their corners only as ridges, in any order; each ridge's side tells its direction. */
Polygon merged_polygon(qhT *qh, facetT *facet)
{
  std::vector<std::array<uint32_t, 2>> steps;
  ridgeT *ridge, **ridgep;
  FOREACHridge_(facet->ridges) {
    const uint32_t a = index_of(qh, SETfirstt_(ridge->vertices, vertexT)), b = index_of(qh, SETsecondt_(ridge->vertices, vertexT));
    if ((ridge->top == facet) == bool(qh_ORIENTclock)) steps.push_back({a, b});
    else steps.push_back({b, a});
  }
  std::sort(steps.begin(), steps.end());
  Polygon corners;
  for (uint32_t at = steps[0][0]; corners.size() < steps.size();) {
    corners.push_back(at);
    const auto step = std::lower_bound(steps.begin(), steps.end(), std::array<uint32_t, 2>{at, 0});
    if (step == steps.end() || (*step)[0] != at) return {};
    at = (*step)[1];
  }
  return corners;
}

} // namespace

std::vector<Polygon> qhull_faces(const std::vector<Double3> &points, double merge_within, const std::string &where)
{
  Messages messages;
  Qhull qhull(messages.file());
  qhT *qh = qhull.state();
  std::vector<Double3> copy = points; /* its interface asks for points that may be written */
  std::string command = merge_within > 0 ? fmt::format("qhull Pp C-{}", merge_within) : "qhull Pp";
  if (qh_new_qhull(qh, 3, int(copy.size()), copy[0].data(), False, command.data(), nullptr, messages.file()) != 0)
    throw InputError(fmt::format("{}: no convex hull of these {} points: {}", where, points.size(), messages.first_line()));
  std::vector<Polygon> faces;
  facetT *facet;
  FORALLfacets faces.push_back(facet->simplicial ? triangle(qh, facet) : merged_polygon(qh, facet));
  return faces;
}

} // namespace tandem
