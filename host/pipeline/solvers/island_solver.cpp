/* island_solver.cpp - see island_solver.h. It is the only file of the simulation that uses Eigen;
 * host/verify/metrics.cpp uses it too, but only measures.
 *
 * Results must be the same on every processor. Eigen's blocked products and factorisations split their sums by the size
 * of the caches, so only its vectors are used, and elimination goes row by row. Manifolds are ordered so that
 * neighbours are near each other; the matrix then has a small bandwidth b, and a stack costs n b^2 instead of n^3.
 */
#include "host/pipeline/solvers/island_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace tandem {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/* Four points of a face can carry one load in many ways, and each float is rounded a little differently, so that none
 * of these ways fits exactly. A compliance, relative to each row's own response, selects the solution nearest to the
 * guess; at rest, where the guess is the solution, it has no effect. With a much smaller compliance, rounding
 * alone would decide which points carry the load. */
constexpr double compliance = 1e-6;
constexpr double tolerance = 1e-9;
constexpr double rounding = 1e-13; /* relative to the sums that make a speed */
constexpr int rounds = 4, newton_limit = 16, first_iterations = 32;
/* Used if plain Newton stalls (proximal point method): a large compliance about the present iterate, with which the
 * problem is easy, and then smaller ones. */
constexpr double softened[] = {1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4};

/* Gaussian elimination with partial pivoting on rows that are non-zero only in [0, ends[i]). The solution replaces
 * `right`; returns false if the matrix is singular. */
bool eliminate(Matrix &a, Vector &right)
{
  const Eigen::Index n = a.rows();
  std::vector<Eigen::Index> ends(static_cast<size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index end = n;
    while (end > 0 && a(i, end - 1) == 0) --end;
    ends[static_cast<size_t>(i)] = end;
  }
  const auto end_of = [&](Eigen::Index i) -> Eigen::Index & { return ends[static_cast<size_t>(i)]; };
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i)
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    if (!(std::abs(a(pivot, k)) > 1e-14)) return false;
    if (pivot != k) {
      a.row(pivot).swap(a.row(k));
      std::swap(right[pivot], right[k]);
      std::swap(end_of(pivot), end_of(k));
    }
    const Eigen::Index length = end_of(k) - k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (a(i, k) == 0) continue;
      const double share = a(i, k) / a(k, k);
      a.row(i).segment(k, length) -= share * a.row(k).segment(k, length);
      right[i] -= share * right[k];
      end_of(i) = std::max(end_of(i), end_of(k));
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    for (Eigen::Index c = k + 1; c < end_of(k); ++c) right[k] -= a(k, c) * right[c];
    right[k] /= a(k, k);
  }
  return true;
}

class IslandSolver {
public:
  explicit IslandSolver(IslandProblem &problem)
      : problem_(problem), n_(problem.rows), matrix_(Eigen::Map<const Matrix>(problem.matrix.data(), n_, n_)),
        offset_(Eigen::Map<const Vector>(problem.offset.data(), n_)), step_(n_), speed_(n_), map_(n_)
  {
    guess_ = Eigen::Map<const Vector>(problem.impulse.data(), n_);
    own_ = matrix_.diagonal();
    yield(compliance, guess_);
    for (Eigen::Index i = 0; i < n_; ++i) step_[i] = 1 / matrix_(i, i);
    for (const ManifoldRows &m : problem_.manifolds)
      if (m.slides) step_[tangent(m)] = step_[tangent(m) + 1] = tangent_step(tangent(m));
    for (Eigen::Index i = 0; i < n_; ++i) {
      Eigen::Index first = 0, last = n_;
      while (first < i && matrix_(i, first) == 0) ++first;
      while (last > i + 1 && matrix_(i, last - 1) == 0) --last;
      reach_.push_back({first, last});
    }
  }

  IslandResult run()
  {
    Vector x = Eigen::Map<const Vector>(problem_.impulse.data(), n_);
    admit(x);
    best_ = x;
    result_.residual = residual(x);
    for (int round = 0; round < rounds && !result_.converged; ++round) {
      newton(x, round % 2 == 0);
      if (result_.converged) break;
      if (residual(x) > result_.residual) x = best_;
      if (round > 0) soften(x);
      iterate(x, first_iterations << round);
    }
    std::copy_n(best_.data(), n_, problem_.impulse.begin());
    return result_;
  }

private:
  /* The range of columns in which a row of the matrix is not zero. */
  struct Reach {
    Eigen::Index first, last;
  };
  const Reach &reach(Eigen::Index i) const { return reach_[static_cast<size_t>(i)]; }

  static Eigen::Index tangent(const ManifoldRows &m) { return m.first + m.normals; }
  static Eigen::Index twist(const ManifoldRows &m) { return tangent(m) + (m.slides ? 2 : 0); }

  /* Makes rows compliant by a share of their own response to the difference of x from `about`. */
  void yield(double share, const Vector &about)
  {
    for (Eigen::Index i = 0; i < n_; ++i) {
      offset_[i] = problem_.offset[static_cast<size_t>(i)] - share * own_[i] * about[i];
      matrix_(i, i) = own_[i] * (1 + share);
    }
  }

  void soften(Vector &x)
  {
    Vector change;
    for (const double share : softened) {
      yield(share, x);
      for (int k = 0; k < newton_limit / 2; ++k) {
        if (residual(x) <= accepted_residual(x)) break;
        const double before = merit();
        linearise(x);
        ++result_.newton_steps;
        if (!newton_change(change) || !change.allFinite() || !search(x, change, before)) break;
      }
      admit(x);
    }
    yield(compliance, guess_);
  }

  /* One step for both tangents, because the projection on a circle would otherwise not be a projection: 1 / largest
   * eigenvalue. */
  double tangent_step(Eigen::Index t) const
  {
    const double a = matrix_(t, t), b = matrix_(t + 1, t + 1), mixed = matrix_(t, t + 1);
    return 2 / (a + b + std::sqrt((a - b) * (a - b) + 4 * mixed * mixed));
  }

  static double normal_impulse_sum(const ManifoldRows &m, const Vector &x)
  {
    double sum = 0;
    for (uint32_t k = 0; k < m.normals; ++k) sum += x[m.first + k];
    return std::max(sum, 0.0);
  }

  void evaluate_speeds(const Vector &x)
  {
    for (Eigen::Index i = 0; i < n_; ++i) {
      double sum = offset_[i];
      for (Eigen::Index k = reach(i).first; k < reach(i).last; ++k) sum += matrix_(i, k) * x[k];
      speed_[i] = sum;
    }
  }

  /* Projects y, in place, to the nearest point that the contact laws allow. */
  static void project_tangent(double radius, double &first, double &second)
  {
    const double length = std::sqrt(first * first + second * second);
    if (length <= radius) return;
    first *= radius / length;
    second *= radius / length;
  }

  void admit(Vector &x) const
  {
    for (const ManifoldRows &m : problem_.manifolds) {
      for (uint32_t k = 0; k < m.normals; ++k) x[m.first + k] = std::max(x[m.first + k], 0.0);
      const double limit = m.friction * normal_impulse_sum(m, x);
      if (m.slides) project_tangent(limit, x[tangent(m)], x[tangent(m) + 1]);
      if (m.twists) x[twist(m)] = std::clamp(x[twist(m)], -limit * m.twist_radius, limit * m.twist_radius);
    }
  }

  /* map = x - projection(x - step * speed), which is zero at a solution. */
  void evaluate_map(const Vector &x)
  {
    evaluate_speeds(x);
    map_ = x - step_.cwiseProduct(speed_);
    for (const ManifoldRows &m : problem_.manifolds) {
      for (uint32_t k = 0; k < m.normals; ++k) map_[m.first + k] = std::max(map_[m.first + k], 0.0);
      const double limit = m.friction * normal_impulse_sum(m, x);
      if (m.slides) project_tangent(limit, map_[tangent(m)], map_[tangent(m) + 1]);
      if (m.twists) map_[twist(m)] = std::clamp(map_[twist(m)], -limit * m.twist_radius, limit * m.twist_radius);
    }
    map_ = x - map_;
  }

  double merit() const
  {
    double sum = 0;
    for (Eigen::Index i = 0; i < n_; ++i) sum += map_[i] * map_[i] / step_[i];
    return sum;
  }

  double residual(const Vector &x)
  {
    evaluate_map(x);
    double worst = 0;
    for (Eigen::Index i = 0; i < n_; ++i) worst = std::max(worst, std::abs(map_[i]) / step_[i]);
    return worst;
  }

  double accepted_residual(const Vector &x) const
  {
    double largest = 0, sums = 0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      double sum = 0;
      for (Eigen::Index k = reach(i).first; k < reach(i).last; ++k) sum += std::abs(matrix_(i, k) * x[k]);
      sums = std::max(sums, sum);
      largest = std::max(largest, std::abs(offset_[i]));
    }
    return tolerance * largest + rounding * sums;
  }

  /* Evaluates the projection of x, because its result is what the bodies receive. Returns true once it is accurate
   * enough. */
  bool keep_if_better(const Vector &x)
  {
    Vector inside = x;
    admit(inside);
    const double now = residual(inside);
    if (now <= result_.residual) {
      result_.residual = now;
      best_ = inside;
    }
    result_.converged = now <= accepted_residual(inside);
    return result_.converged;
  }

  /* Computes the rows of the derivative of the map at x, whose speeds and map must have been evaluated. */
  void linearise(const Vector &x)
  {
    derivative_.setZero(n_, n_);
    for (const ManifoldRows &m : problem_.manifolds) {
      for (uint32_t k = 0; k < m.normals; ++k) {
        const Eigen::Index i = m.first + k;
        if (x[i] - step_[i] * speed_[i] > 0) derivative_.row(i) = step_[i] * matrix_.row(i);
        else derivative_(i, i) = 1;
      }
      const double limit = m.friction * normal_impulse_sum(m, x);
      if (m.slides) linearise_tangent(m, limit, x);
      if (m.twists) linearise_twist(m, limit * m.twist_radius, x);
    }
  }

  /* On the cone the map is x - radius(x) * direction(x - step * speed). */
  void linearise_tangent(const ManifoldRows &m, double radius, const Vector &x)
  {
    const Eigen::Index t = tangent(m);
    const double first = x[t] - step_[t] * speed_[t], second = x[t + 1] - step_[t] * speed_[t + 1];
    const double length = std::sqrt(first * first + second * second);
    if (length <= radius) {
      derivative_.row(t) = step_[t] * matrix_.row(t);
      derivative_.row(t + 1) = step_[t] * matrix_.row(t + 1);
      return;
    }
    derivative_(t, t) = derivative_(t + 1, t + 1) = 1;
    if (radius <= 0) return;
    const double along[2] = {first / length, second / length};
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        const double share = radius / length * ((a == b ? 1.0 : 0.0) - along[a] * along[b]);
        derivative_(t + a, t + b) -= share;
        derivative_.row(t + a) += share * step_[t] * matrix_.row(t + b);
      }
      for (uint32_t k = 0; k < m.normals; ++k) derivative_(t + a, m.first + k) -= along[a] * m.friction;
    }
  }

  void linearise_twist(const ManifoldRows &m, double limit, const Vector &x)
  {
    const Eigen::Index i = twist(m);
    const double wanted = x[i] - step_[i] * speed_[i];
    if (std::abs(wanted) <= limit) {
      derivative_.row(i) = step_[i] * matrix_.row(i);
      return;
    }
    derivative_(i, i) = 1;
    if (limit <= 0) return;
    const double change = (wanted > 0 ? 1 : -1) * m.friction * m.twist_radius;
    for (uint32_t k = 0; k < m.normals; ++k) derivative_(i, m.first + k) -= change;
  }

  bool alone(Eigen::Index i) const
  {
    for (Eigen::Index k = 0; k < n_; ++k)
      if (derivative_(i, k) != (i == k ? 1.0 : 0.0)) return false;
    return true;
  }

  /* Rows that are at rest (the derivative is x = 0 alone) are solved directly; the others are scaled alike and solved
   * by elimination. */
  bool newton_change(Vector &change) const
  {
    change = -map_;
    std::vector<Eigen::Index> coupled;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!alone(i)) coupled.push_back(i);
    const auto size = static_cast<Eigen::Index>(coupled.size());
    if (size == 0) return true;
    std::vector<bool> is_coupled(static_cast<size_t>(n_), false);
    for (Eigen::Index i : coupled) is_coupled[static_cast<size_t>(i)] = true;
    Matrix system(size, size);
    Vector right(size);
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = coupled[static_cast<size_t>(r)];
      const double scale = 1 / std::sqrt(step_[i]);
      double sum = -map_[i];
      for (Eigen::Index k = 0; k < n_; ++k)
        if (!is_coupled[static_cast<size_t>(k)]) sum -= derivative_(i, k) * change[k];
      right[r] = scale * sum;
      for (Eigen::Index c = 0; c < size; ++c) {
        const Eigen::Index k = coupled[static_cast<size_t>(c)];
        system(r, c) = scale * derivative_(i, k) * std::sqrt(step_[k]);
      }
    }
    if (!eliminate(system, right)) return false;
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = coupled[static_cast<size_t>(r)];
      change[i] = right[r] * std::sqrt(step_[i]);
    }
    return true;
  }

  /* If `careful`, no step may increase the map. At a kink every step may do so; whole steps, however large, then often
   * converge. */
  void newton(Vector &x, bool careful)
  {
    Vector change;
    for (int k = 0; k < newton_limit; ++k) {
      if (keep_if_better(x)) return;
      evaluate_map(x);
      const double before = merit();
      linearise(x);
      ++result_.newton_steps;
      if (!newton_change(change) || !change.allFinite()) return;
      if (!careful) x += change;
      else if (!search(x, change, before)) return;
    }
    keep_if_better(x);
  }

  /* Halves the change until it decreases the map. */
  bool search(Vector &x, const Vector &change, double before)
  {
    for (double share = 1; share > 1.0 / 100; share *= 0.5) {
      const Vector there = x + share * change;
      evaluate_map(there);
      if (!(merit() < (1 - 1e-4 * share) * before)) continue;
      x = there;
      return true;
    }
    return false;
  }

  void move(Vector &x, Eigen::Index i, double to)
  {
    const double change = to - x[i];
    if (change == 0) return;
    x[i] = to;
    for (Eigen::Index k = reach(i).first; k < reach(i).last; ++k) speed_[k] += matrix_(i, k) * change;
  }

  void solve_manifold(const ManifoldRows &m, Vector &x)
  {
    for (uint32_t k = 0; k < m.normals; ++k) {
      const Eigen::Index i = m.first + k;
      move(x, i, std::max(x[i] - step_[i] * speed_[i], 0.0));
    }
    const double limit = m.friction * normal_impulse_sum(m, x);
    if (m.slides) {
      const Eigen::Index t = tangent(m);
      double first = x[t] - step_[t] * speed_[t], second = x[t + 1] - step_[t] * speed_[t + 1];
      project_tangent(limit, first, second);
      move(x, t, first);
      move(x, t + 1, second);
    }
    if (!m.twists) return;
    const Eigen::Index i = twist(m);
    move(x, i, std::clamp(x[i] - step_[i] * speed_[i], -limit * m.twist_radius, limit * m.twist_radius));
  }

  void iterate(Vector &x, int count)
  {
    admit(x);
    for (int k = 0; k < count; ++k) {
      if (k % 16 == 0) {
        if (keep_if_better(x)) return;
        evaluate_speeds(x); /* computed afresh, because updates would accumulate their rounding errors */
      }
      for (const ManifoldRows &m : problem_.manifolds) solve_manifold(m, x);
      ++result_.iterations;
    }
    keep_if_better(x);
  }

  IslandProblem &problem_;
  Eigen::Index n_;
  Matrix matrix_, derivative_;
  Vector guess_, own_, offset_, step_, speed_, map_, best_;
  std::vector<Reach> reach_;
  IslandResult result_;
};

} // namespace

IslandResult solve_island(IslandProblem &problem) { return IslandSolver(problem).run(); }

} // namespace tandem
