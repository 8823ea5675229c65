/* joints.cpp - the table of the types of joints, and the validation of joints. */
#include <algorithm>
#include <iterator>
#include <ranges>

#include "host/scene/checker.h"
#include "host/scene/joint_rows.h"
#include "shared/joints/joint_codes.h"

namespace tandem {

std::span<const JointRow> joint_rows()
{
  static constexpr JointRow rows[] = {
#define JOINT(name, directions, rotations, what) {JointType::name, #name, what, directions, rotations},
#include "shared/joints.def"
#undef JOINT
  };
  static_assert(std::ranges::equal(rows, std::views::iota(size_t{0}, std::size(rows)), {},
                                   [](const JointRow &row) { return static_cast<size_t>(row.choice); }));
  return rows;
}

std::span<const char *const> joint_type_names()
{
  static constexpr const char *names[] = {
#define JOINT(name, directions, rotations, what) #name,
#include "shared/joints.def"
#undef JOINT
  };
  return names;
}

const JointRow &row_of(JointType type) { return joint_rows()[static_cast<size_t>(type)]; }

namespace {

std::string names_of_types()
{
  std::string names;
  for (const JointRow &row : joint_rows()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

void check_body(const char *field, uint32_t body, const Scene &scene, const Checker &check)
{
  if (body == no_body || body < scene.bodies.size()) return;
  check.fail(fmt::format("{} {} does not exist; the scene has {} bodies", field, body, scene.bodies.size()));
}

bool moves(uint32_t body, const Scene &scene)
{
  return body != no_body && scene.bodies[body].type == BodyType::dynamic;
}

/* A frame in a body is near it; one in the world may be as far as a body. */
void check_position(const char *field, const Point &position, uint32_t body, const Checker &check)
{
  check.within(field, position, body == no_body ? farthest : double{longest_length});
}

} // namespace

void validate(const Scene &scene, const Joint &joint, size_t index, const std::string &where)
{
  const Checker check{where, "joint", index, joint.name};
  if (static_cast<size_t>(joint.type) >= joint_rows().size())
    check.fail(fmt::format("unknown type; {} exist", names_of_types()));
  check_body("body_a", joint.body_a, scene, check);
  check_body("body_b", joint.body_b, scene, check);
  if (joint.body_a == joint.body_b)
    check.fail(joint.body_a == no_body ? "it connects the world with itself; name body_a or body_b"
                                       : fmt::format("it connects body {} with itself", joint.body_a));
  if (!moves(joint.body_a, scene) && !moves(joint.body_b, scene))
    check.fail("neither of its bodies is dynamic, so it holds nothing; make one of them dynamic");
  check_position("position_a", joint.position_a, joint.body_a, check);
  check_position("position_b", joint.position_b, joint.body_b, check);
  check.unit("orientation_a", joint.orientation_a);
  check.unit("orientation_b", joint.orientation_b);
}

} // namespace tandem
