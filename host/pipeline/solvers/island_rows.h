/* island_rows.h - what the stage solve_islands reads and writes, in double on the host. Of joints and couplings:
 * island_tables.h. */
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/pipeline/solvers/island_tables.h"

namespace tandem {

/* Edges of the graph of bodies: the contacts, then the joints, then the couplings. */
class IslandRows {
public:
  using float4 = in_double::float4;
  using vec3 = in_double::vec3;

  /* Reads what tells the islands: the bodies of edges, points, and which bodies move. Returns whether any of it may be
   * new; within a step it is so once. */
  bool read_graph(Memory &memory);
  void read_rest(Memory &memory);
  /* For a launch that has failed: what it was about to read is read by the next one. */
  void forget() { changed_.forget_all(); }
  void write(Memory &memory);
  /* Writes the entries of counts from COUNT_DIRECT_ISLANDS on, unless the device has them already. */
  using Outcomes = std::array<uint32_t, 3>;
  void write_outcomes(Memory &memory, const Outcomes &outcomes);

  bool bounces() const { return HAS_FEATURE(&parameters, RESTITUTION); }
  bool rubs() const { return HAS_FEATURE(&parameters, FRICTION); }
  uint32_t edges() const { return count + tables.joint_count + tables.coupling_count; }
  bool has_joints() const { return HAS_FEATURE(&parameters, JOINTS); }
  /* For which buffers have room. */
  size_t most_edges() const { return size_t{stride} + tables.most(); }
  bool is_contact(uint32_t edge) const { return edge < count; }
  bool is_joint(uint32_t edge) const { return edge >= count && edge - count < tables.joint_count; }
  uint32_t joint_of(uint32_t edge) const { return edge - count; }
  uint32_t coupling_of(uint32_t edge) const { return edge - count - tables.joint_count; }
  /* The bodies of an edge, INDEX_NONE for each that is the world or not there. A joint without rows connects nothing.
   */
  using Ends = std::array<uint32_t, 4>;
  Ends ends(uint32_t edge) const;
  /* As many contact points as have no fewer rows. */
  uint32_t size_of(uint32_t edge) const;
  uint32_t bodies() const { return static_cast<uint32_t>(velocity.size() / 2); }
  bool moves(uint32_t body) const { return body != INDEX_NONE && velocity[2 * body].w > 0; }
  /* The solver moves all classes of them. */
  in_double::read_turning_bodies turning_bodies() const
  {
    return {inertia.data(), delta.data(), orientation.data(), nullptr};
  }
  bool has_tensors() const { return HAS_FEATURE(&parameters, GYROSCOPIC); }
  double locks(uint32_t body) const { return has_tensors() ? inertia[2 * body + 1].z : 0; }
  vec3 free_part(uint32_t body, const vec3 &v) const;
  /* The change of angular velocity by an angular impulse. */
  vec3 turned_by(uint32_t body, const vec3 &angular_impulse) const;
  double of_point(uint32_t constraint, uint32_t k, uint32_t number) const
  {
    return points[size_t{count} * (k * in_double::POINT_NUMBERS + number) + constraint];
  }
  uint32_t stalled() const { return counts_[COUNT_DIRECT_STALLED]; }

  uint32_t count = 0, stride = 0;
  in_double::Parameters parameters{};
  std::vector<uint32_t> a, b;
  std::vector<float4> normal, center, offset, normal_impulse, friction_impulse, velocity, inertia, delta, orientation,
      restitution;
  std::vector<double> points, slop; /* slop, or the flag for a deep contact: slop_or_deep */
  JointTables tables;

private:
  void read_counts(Memory &memory);
  void read_contacts(Memory &memory);
  void write_contacts(Memory &memory);
  void make_room();
  void read_points(Memory &memory);
  void read_planes(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows);
  void read_changed(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows);
  void read_bodies(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows);
  uint32_t points_of(uint32_t constraint) const;

  std::array<uint32_t, COUNT_TOTAL> counts_{};
  ChangedBuffers changed_;
};

} // namespace tandem
