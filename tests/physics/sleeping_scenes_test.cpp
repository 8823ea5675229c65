/* Every built-in scene with Settings::sleeping: who sleeps rests on something and was slow, who is awake has a reason,
 * and a scene that comes to rest ends where it ends without sleep. */
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "host/catalog/catalog.h"
#include "host/scene/shape_bounds.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr int sleeping_steps = 400, rest_steps = 30; /* Settings::sleep_time is 30 steps */

struct SleepingScene {
  const char *text;
  bool rests; /* all of it sleeps within the steps; what rolls, flies or slides on does not */
};

const std::vector<SleepingScene> &sleeping_scenes()
{
  static const std::vector<SleepingScene> scenes = {
      {"box-grid:nx=4,ny=3,nz=4", true},
      {"falling-boxes:n=40,height=0", true},
      {"box-stack:n=50", true},
      {"pyramid:rows=8", true},
      {"spheres:n=30,height=0,restitution=0.5", false},
      {"mixed:n=50", false},
      /* Of piles of 24 to 40 hulls three settle by more than the slop after all were slow for half a second: 25, 30 and
       * 35. Which ones do changes with the last bits. */
      {"convex-hulls:n=32", true},
      {"shapes:n=30", false},
      {"thin-wall:n=20", false},
      {"bullet-stack:rows=2,height=3", false},
      {"rolling", false},
      {"hulls-on-mesh:n=10", true},
      {"compounds:n=10", false},
      {"mesh-slide:friction=0.6", false},
      {"card-house:storeys=2", true},
      {"arch:courses=4", true},
      {"tower:levels=4", true},
      {"dominoes:n=10", true},
      {"wall:rows=4,length=4", false},
      {"tops", true},
      {"free-flight:n=4", false},
      {"incline", false},
      {"incline:slope=0.2", true},
      {"bounce:n=4", true},
      {"mass-ratio:n=3", true},
      {"pyramid-2d:n=45", true},
      {"talk-3d:nx=2,ny=3,nz=2", true},
      {"joint-grid:columns=8,rows=6", true},
      {"hinge-chain:n=6", false},
      {"pendulums:n=4", false},
      {"bridge", false},
      {"wrecking-ball", false},
      {"ragdolls:n=2", true},
      {"motor-mill:wheels=3,stones=8", false},
      {"crane:rows=2", false},
      {"newton-cradle:n=4", false},
      {"four-bar", false},
      {"vehicle", false},
      {"vehicle:speed=0,hills=0", true},
      {"humanoid:n=2", true},
      {"humanoid:n=2,height=0.3,stiffness=0", false},
  };
  return scenes;
}

using Neighbours = std::map<uint32_t, std::set<uint32_t>>;

/* Of one scene; the world is observed step by step. */
class SleepObserver {
public:
  explicit SleepObserver(const char *text) : world_(load_scene(text), settings(), {"serial", {}})
  {
    before_ = world_.bodies();
    rested_.resize(before_.size());
  }

  void step()
  {
    world_.step();
    now_ = world_.bodies();
    for (const SleepEvent &event : world_.sleep_events()) {
      if (!event.asleep) places_.erase(event.body.index);
      else {
        require_slow(event.body.index);
        places_[event.body.index] = now_[event.body.index];
      }
    }
    require_support();
    for (const auto &[body, place] : places_) require_still(body, place);
    for (uint32_t body = 0; body < now_.size(); ++body)
      rested_[body] = is_slow(body, now_[body]) ? rested_[body] + 1 : 0;
    require_reason_to_be_awake();
    before_ = now_;
  }

  World &world() { return world_; }
  uint32_t dynamic_bodies() const
  {
    const std::vector<Body> &bodies = world_.scene().bodies;
    return uint32_t(
        std::count_if(bodies.begin(), bodies.end(), [](const Body &b) { return b.type == BodyType::dynamic; }));
  }

private:
  static Settings settings()
  {
    Settings settings;
    settings.sleeping = settings.events = settings.pair_events = true;
    return settings;
  }

  bool is_dynamic_body(uint32_t body) const { return world_.scene().bodies[body].type == BodyType::dynamic; }

  /* No point of the body's bounding sphere is faster than what Settings says; a hair more for rounding. */
  bool is_slow(uint32_t body, const BodyState &state) const
  {
    const Scene &scene = world_.scene();
    const double radius = double(bounding_radius(scene, scene.bodies[body])),
                 limit = double(world_.settings().sleep_speed) * std::min(1.0, 2 * radius);
    return vector_of(state.linear_velocity).norm() + radius * vector_of(state.angular_velocity).norm() <= 1.001 * limit;
  }

  void require_slow(uint32_t body)
  {
    INFO("body " << body << " falls asleep in step " << world_.statistics().steps);
    REQUIRE(is_slow(body, before_[body]));
    REQUIRE(rested_[body] >= rest_steps - 1);
  }

  void require_still(uint32_t body, const BodyState &place)
  {
    const BodyState &state = now_[body];
    if (state.position == place.position && state.orientation == place.orientation &&
        state.linear_velocity == Vec3{0, 0, 0} && state.angular_velocity == Vec3{0, 0, 0})
      return;
    FAIL("body " << body << " sleeps and moves in step " << world_.statistics().steps);
  }

  /* Bodies that can be reached from the first ones along neighbours. */
  static std::set<uint32_t> reached(std::vector<uint32_t> todo, const Neighbours &neighbours)
  {
    std::set<uint32_t> found(todo.begin(), todo.end());
    while (!todo.empty()) {
      const uint32_t body = todo.back();
      todo.pop_back();
      const auto row = neighbours.find(body);
      if (row == neighbours.end()) continue;
      for (const uint32_t next : row->second)
        if (found.insert(next).second) todo.push_back(next);
    }
    return found;
  }

  /* Joints hold as contacts do, and so do couplings of these. */
  void add_joints(Neighbours &neighbours, bool among_dynamic) const
  {
    for (const Joint &joint : world_.scene().joints) {
      if (joint.body_a == no_body || joint.body_b == no_body) continue;
      if (among_dynamic && !(is_dynamic_body(joint.body_a) && is_dynamic_body(joint.body_b))) continue;
      neighbours[joint.body_a].insert(joint.body_b), neighbours[joint.body_b].insert(joint.body_a);
    }
    for (const Coupling &coupling : world_.scene().couplings) {
      const Joint &one = world_.scene().joints[coupling.joint_a], &other = world_.scene().joints[coupling.joint_b];
      for (const uint32_t a : {one.body_a, one.body_b})
        for (const uint32_t b : {other.body_a, other.body_b})
          if (a != no_body && b != no_body && (!among_dynamic || (is_dynamic_body(a) && is_dynamic_body(b))))
            neighbours[a].insert(b), neighbours[b].insert(a);
    }
  }

  /* Whoever falls asleep touches the fixed bodies or hangs from them, directly or through others. */
  void require_support()
  {
    Neighbours touching;
    for (const ContactEvent &event : world_.contact_events())
      if (event.kind != ContactEvent::Kind::end) touching[event.a].insert(event.b), touching[event.b].insert(event.a);
    add_joints(touching, false);
    std::vector<uint32_t> fixed;
    for (uint32_t body = 0; body < now_.size(); ++body)
      if (!is_dynamic_body(body)) fixed.push_back(body);
    for (const Joint &joint : world_.scene().joints) {
      if (joint.body_a == no_body) fixed.push_back(joint.body_b);
      if (joint.body_b == no_body) fixed.push_back(joint.body_a);
    }
    const std::set<uint32_t> supported = reached(fixed, touching);
    for (const SleepEvent &event : world_.sleep_events()) {
      INFO("body " << event.body.index << " in step " << world_.statistics().steps);
      if (event.asleep) REQUIRE(supported.count(event.body.index));
    }
  }

  /* Contacts join bodies ahead of touching, too, but none whose bounds do not overlap. So a body that has rested for
   * long is awake only if one that has not can be reached over dynamic bodies whose bounds overlap. */
  void require_reason_to_be_awake()
  {
    Neighbours near;
    for (const PairEvent &event : world_.pair_events())
      if (event.kind != ContactEvent::Kind::end && is_dynamic_body(event.a) && is_dynamic_body(event.b))
        near[event.a].insert(event.b), near[event.b].insert(event.a);
    add_joints(near, true);
    std::vector<uint32_t> restless;
    for (uint32_t body = 0; body < now_.size(); ++body)
      if (is_dynamic_body(body) && !places_.count(body) && rested_[body] <= rest_steps + 2) restless.push_back(body);
    const std::set<uint32_t> excused = reached(restless, near);
    for (uint32_t body = 0; body < now_.size(); ++body)
      if (is_dynamic_body(body) && !places_.count(body) && !excused.count(body))
        FAIL("body " << body << " rests and is awake after step " << world_.statistics().steps);
  }

  World world_;
  std::vector<BodyState> before_, now_;
  std::vector<int> rested_;              /* steps at whose ends each body was slow, up to now */
  std::map<uint32_t, BodyState> places_; /* where those who sleep fell asleep */
};

std::vector<BodyState> end_without_sleep(const char *text)
{
  World world(load_scene(text), {}, {"serial", {}});
  for (int k = 0; k < sleeping_steps; ++k) world.step();
  return world.bodies();
}

} // namespace

TEST_CASE("every built-in scene is among those that are run with sleep")
{
  std::set<std::string> named;
  for (const SleepingScene &scene : sleeping_scenes()) named.insert(parse_scene_spec(scene.text).scene->name);
  for (const BuiltInScene &scene : built_in_scenes()) {
    INFO(scene.name);
    CHECK(named.count(scene.name) == 1);
  }
}

TEST_CASE("in every built-in scene those who rest sleep, on something, and nobody else does")
{
  for (const SleepingScene &scene : sleeping_scenes()) {
    INFO(scene.text);
    SleepObserver observer(scene.text);
    for (int k = 0; k < sleeping_steps; ++k) observer.step();
    CHECK(observer.world().quarantined().empty());
    if (!scene.rests) {
      CHECK(observer.world().statistics().asleep < observer.dynamic_bodies());
      continue;
    }
    CHECK(observer.world().statistics().asleep == observer.dynamic_bodies());
    const std::vector<BodyState> asleep = observer.world().bodies(), awake = end_without_sleep(scene.text);
    for (size_t body = 0; body < asleep.size(); ++body)
      CHECK((vector_of(asleep[body].position) - vector_of(awake[body].position)).norm() <
            double(observer.world().settings().slop));
  }
}
