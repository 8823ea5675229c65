/* island.h - one small island as a dense problem: the rows of its contacts, joints and couplings, and what their
 * solution does to the bodies.
 *
 *   speed of a row = sum over its sides: direction . velocity + turn . angular velocity
 *
 * A contact or joint has two sides, a coupling up to four.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/base/arena.h"
#include "host/pipeline/solvers/island_rows.h"
#include "host/pipeline/solvers/island_solver.h"
#include "host/pipeline/solvers/islands.h"

namespace tandem {

/* What a unit impulse of a row gives a body. */
struct RowSide {
  uint32_t body = 0;
  in_double::vec3 direction{}, turn{};
};

struct IslandRow {
  void add_side(uint32_t body, const in_double::vec3 &direction, const in_double::vec3 &turn)
  {
    sides[count++] = {body, direction, turn};
  }

  std::array<RowSide, 4> sides;
  uint32_t count = 0;        /* of the sides; the world is none */
  double *impulse = nullptr; /* where it is stored */
  double share = 0;          /* by which it is compliant to its whole impulse, of its own response */
  double change_share = 0;   /* and to the change of its impulse, by that */
  double kept_speed = 0; /* the change counts from an impulse that gives the row no more than this speed, m/s, rad/s */
  double compliance = 0; /* beside these: of a spring */
};

/* A limit has one impulse for both of its ends, each of which is a row. */
struct LimitRows {
  double lower = 0, upper = 0;
  double *impulse = nullptr; /* lower - upper */
};

/* A manifold has at most four points, and three rows beside theirs. An island has most rows where each point is a
 * manifold of its own. */
constexpr size_t most_constraint_rows = 7, most_island_rows = 4 * most_island_points;

/* What the solution of one island takes. A task keeps it for the islands of this launch and of later ones. */
struct IslandMemory {
  void reserve(size_t most_constraints, bool joints)
  {
    const size_t rows = joints ? most_island_rows : std::min(most_constraint_rows * most_constraints, most_island_rows);
    list.reserve(rows);
    problem.matrix.reserve(rows * rows);
    problem.offset.reserve(rows);
    problem.impulse.reserve(rows);
    problem.manifolds.reserve(std::min<size_t>(most_constraints, most_island_points));
    if (joints) {
      problem.bounded.reserve(rows);
      limits.reserve(rows);
    }
    arena.reserve(island_solver_bytes(rows));
  }
  void clear()
  {
    list.clear();
    limits.clear();
    problem.offset.clear();
    problem.impulse.clear();
    problem.manifolds.clear();
    problem.bounded.clear();
  }

  std::vector<IslandRow> list;
  std::vector<LimitRows> limits; /* never more than reserved, so that rows may point to their numbers */
  IslandProblem problem;
  Arena arena;
};

class Island {
public:
  /* edges: as IslandRows numbers them. */
  Island(IslandRows &rows, std::span<const uint32_t> edges, uint32_t pass, IslandMemory &memory);

  bool is_finite() const;
  /* Returns false if the solver stalled. */
  bool solve();

private:
  using vec3 = in_double::vec3;

  void add_contact(uint32_t i);
  void add_normals(uint32_t i, const in_double::contact &c, const in_double::normal_rows &s,
                   const in_double::delta_pose &moved);
  void add_friction(uint32_t i, const in_double::contact &c, in_double::arm_shift shift);
  bool normal_row(uint32_t i, uint32_t k, double separation, double rate, double &bias) const;

  void add_joint(uint32_t i);
  void add_angular_block(uint32_t i, const in_double::joint &j, const in_double::joint_frames &f);
  void add_linear_block(uint32_t i, const in_double::joint &j, const in_double::joint_frames &f);
  void add_axes(uint32_t i, const in_double::joint &j, const in_double::joint_frames &f);
  void add_drive(const IslandRow &along, const in_double::joint_axis &axis, double value, in_double::float4 &kept);
  void add_motor(IslandRow row, const in_double::joint_axis &axis, double value, double most);
  void add_position(IslandRow row, double closing, double lower);
  void add_friction_of_axis(const IslandRow &along, const in_double::joint_axis &axis, in_double::float4 &kept);
  void add_largest_speed(const IslandRow &along, double largest);
  void add_limits(const IslandRow &along, const in_double::joint_axis &axis, double value, in_double::float4 &kept);
  void add_soft_limit(IslandRow row, const in_double::joint_axis &axis, double open, double lower);
  void add_stop(IslandRow row, const in_double::joint_axis &axis, double open);
  void add_held(IslandRow row, double open, const in_double::joint_axis &axis);
  void add_coupling(uint32_t i);

  static IslandRow row_between(uint32_t a, uint32_t b, const vec3 &direction, const vec3 &turn_a, const vec3 &turn_b,
                               double &impulse);
  bool responds(const IslandRow &row) const;
  void add_row(const IslandRow &row, double bias);
  void add_bounded(const IslandRow &row, double bias, double lower, double upper);

  void assemble();
  void soften();
  void apply();
  void note_highest();
  double speed_of(const IslandRow &row) const;
  void push(const RowSide &side, double impulse);

  IslandRows &rows_;
  std::span<const uint32_t> edges_;
  uint32_t pass_;
  std::vector<IslandRow> &list_;
  std::vector<LimitRows> &limits_;
  IslandProblem &problem_;
  Arena &arena_;
};

/* The numbers of a row of four. */
double *component_of(in_double::float4 &row, uint32_t k);
double value_of(const in_double::float4 &row, uint32_t k);

} // namespace tandem
