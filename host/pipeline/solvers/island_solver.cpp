/* island_solver.cpp - see island_solver.h. It is the only file of the simulation that uses Eigen;
 * host/verify/metrics.cpp uses it too, but only measures.
 *
 * Results must be the same on every processor. Eigen's blocked products and factorisations split their sums by the size
 * of the caches, so only its vectors are used, and elimination goes row by row. Manifolds are ordered so that
 * neighbours are near each other; the matrix then has a small bandwidth b, and a stack costs n b^2 instead of n^3.
 *
 * A step solves many islands in many passes, so all vectors and matrices lie in an arena that the caller keeps. Eigen's
 * own would allocate in each solve.
 */
#include "host/pipeline/solvers/island_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace tandem {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;
using Given = Eigen::Map<const Eigen::VectorXd>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Matrix = Eigen::Map<RowMajor>;

/* The range of columns in which a row of a matrix is not zero. */
struct Reach {
  Eigen::Index first, last;
};

/* Four points of a face can carry one load in many ways, and each float is rounded a little differently, so that none
 * of these ways fits exactly. A compliance, relative to each row's own response, selects the solution nearest to the
 * guess; at rest, where the guess is the solution, it has no effect. With a much smaller compliance, rounding
 * alone would decide which points carry the load.
 *
 * A body held from two sides cannot have the speeds that both want, and its impulses would grow until the compliance
 * gives way, to a million times what the body weighs. Such rows are as soft as `soft` (follow_loads): they grip, and
 * let go when the body comes loose. From `noticeable` on, as a share of the largest speed, what a row yields counts. */
constexpr double compliance = 1e-6, soft = 0.01, noticeable = 1e-4, as_much = 0.999;
constexpr int most_loads = 8;
constexpr double tolerance = 1e-9;
constexpr double rounding = 1e-13; /* relative to the sums that make a speed */
constexpr int rounds = 4, newton_limit = 16, first_iterations = 32;
/* Used if plain Newton stalls (proximal point method): a large compliance about the present iterate, with which the
 * problem is easy, and then smaller ones. */
constexpr double softened[] = {1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4};

/* Gaussian elimination with partial pivoting on rows that are non-zero only in [0, ends[i]), which it computes. The
 * solution replaces `right`; returns false if the matrix is singular. */
bool eliminate(Matrix &a, Vector &right, Eigen::Index *ends)
{
  const Eigen::Index n = a.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    ends[i] = n;
    while (ends[i] > 0 && a(i, ends[i] - 1) == 0) --ends[i];
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i)
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    if (!(std::abs(a(pivot, k)) > 1e-14)) return false;
    if (pivot != k) {
      a.row(pivot).swap(a.row(k));
      std::swap(right[pivot], right[k]);
      std::swap(ends[pivot], ends[k]);
    }
    const Eigen::Index length = ends[k] - k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (a(i, k) == 0) continue;
      const double share = a(i, k) / a(k, k);
      a.row(i).segment(k, length) -= share * a.row(k).segment(k, length);
      right[i] -= share * right[k];
      ends[i] = std::max(ends[i], ends[k]);
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    for (Eigen::Index c = k + 1; c < ends[k]; ++c) right[k] -= a(k, c) * right[c];
    right[k] /= a(k, k);
  }
  return true;
}

class IslandSolver {
public:
  IslandSolver(IslandProblem &problem, Arena &arena)
      : problem_(problem), arena_(arena), n_(problem.rows), reach_(arena.take<Reach>(problem.rows)),
        ends_(arena.take<Eigen::Index>(problem.rows)), coupled_(arena.take<Eigen::Index>(problem.rows)),
        is_coupled_(arena.take<bool>(problem.rows))
  {
    matrix_ = Eigen::Map<const RowMajor>(problem.matrix.data(), n_, n_);
    near_ = x_ = guess();
    own_ = matrix_.diagonal();
    compliance_.setConstant(compliance);
    yield_near();
    for (Eigen::Index i = 0; i < n_; ++i) step_[i] = 1 / matrix_(i, i);
    for (const ManifoldRows &m : problem_.manifolds)
      if (m.slides) step_[tangent(m)] = step_[tangent(m) + 1] = tangent_step(tangent(m));
    for (Eigen::Index i = 0; i < n_; ++i) {
      Eigen::Index first = 0, last = n_;
      while (first < i && matrix_(i, first) == 0) ++first;
      while (last > i + 1 && matrix_(i, last - 1) == 0) --last;
      reach_[i] = {first, last};
    }
  }

  IslandResult run()
  {
    approach();
    follow_loads();
    result_.yielded = most_yielded(true);
    std::copy_n(best_.data(), n_, problem_.impulse.begin());
    return result_;
  }

private:
  /* From x_ to the solution nearest to near_. */
  void approach()
  {
    admit(x_);
    best_ = x_;
    result_.residual = residual(x_);
    result_.converged = false;
    for (int round = 0; round < rounds && !result_.converged; ++round) {
      newton(x_, round % 2 == 0);
      if (result_.converged) break;
      if (residual(x_) > result_.residual) x_ = best_;
      if (round > 0) soften(x_);
      iterate(x_, first_iterations << round);
    }
  }

  Given guess() const { return {problem_.impulse.data(), n_}; }
  bool is_soft(Eigen::Index i) const { return compliance_[i] == soft; }

  /* What the compliance has taken from the speed that a row wants. */
  double yielded(Eigen::Index i) const { return compliance_[i] * own_[i] * std::abs(best_[i] - near_[i]); }
  double most_yielded(bool counts_soft_rows) const
  {
    double most = 0;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (counts_soft_rows || !is_soft(i)) most = std::max(most, yielded(i));
    return most;
  }

  /* Under a load far above what bears it, the compliance yields less about each solution than about the one before
   * (proximal point method). Where it yields as much again, rows want what cannot be. */
  void follow_loads()
  {
    const double least = noticeable * Given(problem_.offset.data(), n_).cwiseAbs().maxCoeff();
    for (int k = 0; k < most_loads && most_yielded(false) > least; ++k) {
      for (Eigen::Index i = 0; i < n_; ++i) before_[i] = yielded(i);
      approach_near(best_);
      if (soften_contradictions(least)) approach_near(guess());
    }
  }

  /* The rows that yield as much as before, and at least so much, become soft. */
  bool soften_contradictions(double least)
  {
    bool are_there = false;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (is_soft(i) || !(yielded(i) > least && yielded(i) > as_much * before_[i])) continue;
      compliance_[i] = soft;
      are_there = true;
    }
    return are_there;
  }

  /* Soft rows yield to their whole impulses, all others to what they differ from these. */
  template <class Impulses> void approach_near(const Impulses &impulses)
  {
    near_ = x_ = impulses;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (is_soft(i)) near_[i] = 0;
    yield_near();
    approach();
  }

  Vector vector() { return {arena_.take<double>(static_cast<size_t>(n_)), n_}; }
  Matrix square() { return {arena_.take<double>(static_cast<size_t>(n_ * n_)), n_, n_}; }

  static Eigen::Index tangent(const ManifoldRows &m) { return m.first + m.normals; }
  static Eigen::Index twist(const ManifoldRows &m) { return tangent(m) + (m.slides ? 2 : 0); }

  /* Makes a row compliant by a share of its own response to the difference of x from `about`. */
  void yield(Eigen::Index i, double share, double about)
  {
    offset_[i] = problem_.offset[static_cast<size_t>(i)] - share * own_[i] * about;
    matrix_(i, i) = own_[i] * (1 + share);
  }
  void yield_near()
  {
    for (Eigen::Index i = 0; i < n_; ++i) yield(i, compliance_[i], near_[i]);
  }

  void soften(Vector &x)
  {
    for (const double share : softened) {
      for (Eigen::Index i = 0; i < n_; ++i) yield(i, share, x[i]);
      for (int k = 0; k < newton_limit / 2; ++k) {
        if (residual(x) <= accepted_residual(x)) break;
        const double before = merit();
        linearise(x);
        ++result_.newton_steps;
        if (!newton_change() || !change_.allFinite() || !search(x, before)) break;
      }
      admit(x);
    }
    yield_near();
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
      for (Eigen::Index k = reach_[i].first; k < reach_[i].last; ++k) sum += matrix_(i, k) * x[k];
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
    for (const BoundedRow &b : problem_.bounded) x[b.row] = std::clamp(x[b.row], b.lower, b.upper);
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
    for (const BoundedRow &b : problem_.bounded) map_[b.row] = std::clamp(map_[b.row], b.lower, b.upper);
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
      for (Eigen::Index k = reach_[i].first; k < reach_[i].last; ++k) sum += std::abs(matrix_(i, k) * x[k]);
      sums = std::max(sums, sum);
      largest = std::max(largest, std::abs(offset_[i]));
    }
    return tolerance * largest + rounding * sums;
  }

  /* Evaluates the projection of x, because its result is what the bodies receive. Returns true once it is accurate
   * enough. */
  bool keep_if_better(const Vector &x)
  {
    inside_ = x;
    admit(inside_);
    const double now = residual(inside_);
    if (now <= result_.residual) {
      result_.residual = now;
      best_ = inside_;
    }
    result_.converged = now <= accepted_residual(inside_);
    return result_.converged;
  }

  /* Computes the rows of the derivative of the map at x, whose speeds and map must have been evaluated. */
  void linearise(const Vector &x)
  {
    derivative_.setZero();
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
    for (const BoundedRow &b : problem_.bounded) linearise_bounded(b, x);
  }

  void linearise_bounded(const BoundedRow &b, const Vector &x)
  {
    const double wanted = x[b.row] - step_[b.row] * speed_[b.row];
    if (wanted > b.lower && wanted < b.upper) derivative_.row(b.row) = step_[b.row] * matrix_.row(b.row);
    else derivative_(b.row, b.row) = 1;
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
  bool newton_change()
  {
    change_ = -map_;
    Eigen::Index size = 0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      is_coupled_[i] = !alone(i);
      if (is_coupled_[i]) coupled_[size++] = i;
    }
    if (size == 0) return true;
    Matrix system(system_.data(), size, size);
    Vector right(right_.data(), size);
    for (Eigen::Index r = 0; r < size; ++r) {
      const Eigen::Index i = coupled_[r];
      const double scale = 1 / std::sqrt(step_[i]);
      double sum = -map_[i];
      for (Eigen::Index k = 0; k < n_; ++k)
        if (!is_coupled_[k]) sum -= derivative_(i, k) * change_[k];
      right[r] = scale * sum;
      for (Eigen::Index c = 0; c < size; ++c)
        system(r, c) = scale * derivative_(i, coupled_[c]) * std::sqrt(step_[coupled_[c]]);
    }
    if (!eliminate(system, right, ends_)) return false;
    for (Eigen::Index r = 0; r < size; ++r) change_[coupled_[r]] = right[r] * std::sqrt(step_[coupled_[r]]);
    return true;
  }

  /* If `careful`, no step may increase the map. At a kink every step may do so; whole steps, however large, then often
   * converge. */
  void newton(Vector &x, bool careful)
  {
    for (int k = 0; k < newton_limit; ++k) {
      if (keep_if_better(x)) return;
      evaluate_map(x);
      const double before = merit();
      linearise(x);
      ++result_.newton_steps;
      if (!newton_change() || !change_.allFinite()) return;
      if (!careful) x += change_;
      else if (!search(x, before)) return;
    }
    keep_if_better(x);
  }

  /* Halves the change until it decreases the map. */
  bool search(Vector &x, double before)
  {
    for (double share = 1; share > 1.0 / 100; share *= 0.5) {
      there_ = x + share * change_;
      evaluate_map(there_);
      if (!(merit() < (1 - 1e-4 * share) * before)) continue;
      x = there_;
      return true;
    }
    return false;
  }

  void move(Vector &x, Eigen::Index i, double to)
  {
    const double change = to - x[i];
    if (change == 0) return;
    x[i] = to;
    for (Eigen::Index k = reach_[i].first; k < reach_[i].last; ++k) speed_[k] += matrix_(i, k) * change;
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
      for (const BoundedRow &b : problem_.bounded)
        move(x, b.row, std::clamp(x[b.row] - step_[b.row] * speed_[b.row], b.lower, b.upper));
      for (const ManifoldRows &m : problem_.manifolds) solve_manifold(m, x);
      ++result_.iterations;
    }
    keep_if_better(x);
  }

  IslandProblem &problem_;
  Arena &arena_;
  Eigen::Index n_;
  Reach *reach_;
  Eigen::Index *ends_, *coupled_; /* of elimination; the rows that take part in it */
  bool *is_coupled_;
  Matrix matrix_ = square(), derivative_ = square(), system_ = square();
  Vector near_ = vector(), own_ = vector(), compliance_ = vector(), before_ = vector(), offset_ = vector(),
         step_ = vector(), speed_ = vector(), map_ = vector(), x_ = vector(), best_ = vector(), inside_ = vector(),
         there_ = vector(), change_ = vector(), right_ = vector();
  IslandResult result_;
};

} // namespace

IslandResult solve_island(IslandProblem &problem, Arena &arena)
{
  if (problem.rows == 0) return {.converged = true};
  arena.clear();
  return IslandSolver(problem, arena).run();
}

/* The sum of the members of IslandSolver that lie in the arena, which throws where one was forgotten here. */
size_t island_solver_bytes(size_t rows)
{
  return 3 * Arena::bytes_of<double>(rows * rows) + 14 * Arena::bytes_of<double>(rows) +
         2 * Arena::bytes_of<Eigen::Index>(rows) + Arena::bytes_of<Reach>(rows) + Arena::bytes_of<bool>(rows);
}

} // namespace tandem
