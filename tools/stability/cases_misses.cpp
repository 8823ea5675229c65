/* cases_misses.cpp - what misses goes on, and what hits does not go through: movers past an edge, a corner, a mesh's edge and a rotor.
 *
 * Contacts are made ahead of touching, so that nothing is passed unseen within a step. A contact that is made where the step would never
 * touch acts as an endless plane: it stops what would have missed.
 */
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/stability/passes.h"

namespace tandem::stability {
namespace {

struct ObstacleName {
  Obstacle obstacle;
  const char *name, *words;
};
constexpr ObstacleName obstacles[] = {{Obstacle::edge, "edge", "the edge of a cube"},
                                      {Obstacle::corner, "corner", "the corner of a cube"},
                                      {Obstacle::mesh_edge, "mesh-edge", "the ridge of a mesh"},
                                      {Obstacle::rotor, "rotor", "the tips of a bar of 1 m that turns at 100 rad/s"}};

/* Energy kept by one body of a lane, as a share of that at the start. */
double kept(const Moment &moment, size_t body)
{
  const Body &start = moment.scene().bodies[body];
  const BodyState at_start{start.position, start.orientation, start.linear_velocity, start.angular_velocity};
  const double energy = kinetic_energy(moment.scene(), start, at_start);
  return energy > 0 ? kinetic_energy(moment.scene(), start, moment.bodies[body]) / energy : 1.0;
}

/* Over the lanes, and over both bodies of each; NaN stays. */
Figure largest_loss(const std::vector<Lane> &lanes)
{
  return [lanes](const Moment &moment) {
    double worst = 0;
    for (const Lane &lane : lanes)
      for (size_t body : {lane.obstacle, lane.mover}) {
        const double loss = 1 - kept(moment, body);
        if (loss > worst || std::isnan(loss)) worst = loss;
      }
    return worst;
  };
}

/* Of the mover that keeps the most. */
Figure most_kept(const std::vector<Lane> &lanes)
{
  return [lanes](const Moment &moment) {
    double most = 0;
    for (const Lane &lane : lanes) {
      const double share = kept(moment, lane.mover);
      if (share > most || std::isnan(share)) most = share;
    }
    return most;
  };
}

/* Centres in front of the wall give 0. */
Figure farthest_beyond(const std::vector<Lane> &lanes)
{
  return [lanes](const Moment &moment) {
    double worst = 0;
    for (const Lane &lane : lanes) {
      const double x = moment.bodies[lane.mover].position[0];
      if (x > worst || std::isnan(x)) worst = x;
    }
    return worst;
  };
}

constexpr uint64_t steps = 40; /* the slowest are over the obstacle after 19 */

/* Speeds do not change at all where there is no contact; what a user sees is a thousandth. */
Bound a_thousandth() { return Bound::promised(0.001, "what misses keeps 99.9% of its energy; without a contact it is all of it"); }

Case miss_case(const Mover &mover, const ObstacleName &past)
{
  return {fmt::format("miss-{}-{}", mover.name, past.name), "what misses goes on",
          fmt::format("a {} passes {} by 1 mm, 1 cm and 2 cm, at 1, 5, 30, 100 and 300 m/s", mover.name, past.words),
          "keeps 99.9% of its kinetic energy, and so does what it passes",
          [mover, past](Length length) {
            Passes passes = passes_of(mover, past.obstacle, {0.001, 0.01, 0.02});
            Trial trial = trial_of(std::move(passes.scene), steps_for(length, steps, steps));
            trial.checks.push_back(check("largest loss of kinetic energy", "", a_thousandth(), largest_loss(passes.lanes)));
            return trial;
          }};
}

/* A graze takes more than a miss may: a ball of 5 cm that overlaps an edge by 1 mm meets it at 11 degrees and loses 4% of its energy to a
 * contact without friction and restitution. */
Case graze_case(const Mover &mover, const ObstacleName &past)
{
  return {fmt::format("graze-{}-{}", mover.name, past.name), "what hits is stopped",
          fmt::format("a {} overlaps {} by 1 mm and 1 cm on its way, at 1, 5, 30, 100 and 300 m/s", mover.name, past.words),
          "every one of them is deflected: it loses a thousandth of its energy at least; energy never grows",
          [mover, past](Length length) {
            Passes passes = passes_of(mover, past.obstacle, {-0.001, -0.01});
            Trial trial = trial_of(std::move(passes.scene), steps_for(length, steps, steps));
            trial.checks.push_back(at_end(check("most of its energy kept by one", "", 0.999, most_kept(passes.lanes))));
            trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
            return trial;
          }};
}

Case wall_case(const Mover &mover, bool mesh)
{
  return {fmt::format("hit-{}-{}", mover.name, mesh ? "sheet" : "wall"), "what hits is stopped",
          fmt::format("a {} against {}, at 1, 5, 30, 100 and 300 m/s", mover.name, mesh ? "a sheet of two triangles" : "a wall of 1 cm"),
          "its centre never gets beyond the middle of the wall; energy never grows",
          [mover, mesh](Length length) {
            Passes passes = hits_on_wall(mover, mesh);
            Trial trial = trial_of(std::move(passes.scene), steps_for(length, steps, steps));
            trial.checks.push_back(check("got beyond the wall by", "m", 0, farthest_beyond(passes.lanes)));
            trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
            return trial;
          }};
}

} // namespace

void add_misses_cases(std::vector<Case> &cases)
{
  for (const ObstacleName &past : obstacles)
    for (const Mover &mover : movers()) cases.push_back(miss_case(mover, past));
  for (const ObstacleName &past : obstacles)
    for (const Mover &mover : movers()) cases.push_back(graze_case(mover, past));
  for (bool mesh : {false, true})
    for (const Mover &mover : movers()) cases.push_back(wall_case(mover, mesh));
}

} // namespace tandem::stability
