/* joint_recoloring.h - the colours of joints while joints come and go one at a time.
 *
 * The graph of joints (joint_graph.h) gives each joint the lowest colour that is free at both of its bodies, in the
 * order of the scene. So one that comes or goes changes the colours of later joints alone, and of those only where the
 * change goes on from body to body:
 *
 *   joints   0: a-b  1: b-c  2: d-e  3: c-f         0 goes: 1 gets its colour, then 3 that of 1; 2 is not looked at
 *
 * The result is that of the graph made anew after each change, of which this tells the bodies that got a colour.
 * It takes as long as a change goes on: most end after a few joints, but in a chain that loses its first joint again
 * and again each goes to the end, for 20 ns a joint.
 */
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include <tandem/scene.h>

#include "host/scene/joint_graph.h"

namespace tandem {

struct JointedLinks;

/* A joint as an edge of the graph of bodies. */
struct JointEdge {
  uint32_t a = no_body, b = no_body;
  bool has_color = false; /* besides contacts: it is enabled and holds no link */
};
JointEdge edge_of(const Joint &joint, const JointedLinks &links);

class JointRecoloring {
public:
  /* Of the joints of the scene, of which graph has the colours. The scene stays where it is. */
  JointRecoloring(const Scene &scene, const JointedLinks &links, const JointGraph &graph);

  /* The joint of this number, which may be a new one, is another. */
  void change(uint32_t number, const JointEdge &now);
  /* The bodies that some change gave a colour that they had not just before it, ascending. */
  std::vector<uint32_t> bodies_with_new_colors() const { return {recolored_.begin(), recolored_.end()}; }

private:
  /* A body that the present change has reached. */
  struct Reached {
    uint64_t before = 0;  /* the colours in use before the change */
    uint64_t differs = 0; /* those whose use by the joints so far has changed */
    uint64_t change = 0;  /* the number of the change */
  };

  void list(const JointEdge &edge, uint32_t number, bool listed);
  uint64_t used_before(uint32_t body, uint32_t number) const;
  void recolor(uint32_t number);
  void go_on(uint32_t body, uint32_t number, uint64_t changed);
  void look_at(uint32_t number);

  const Scene &scene_;
  std::vector<JointEdge> edges_;
  std::vector<uint64_t> bit_;                  /* by joint: that of its colour; 0: none, or past the last one */
  std::vector<std::vector<uint32_t>> of_body_; /* joints with colours and past the last one, ascending */
  std::vector<uint64_t> used_;                 /* by body */
  std::vector<Reached> reached_;               /* by body */
  std::vector<uint32_t> touched_, to_look_at_; /* by the present change: bodies; joints, a heap */
  uint64_t changes_ = 0;
  std::set<uint32_t> recolored_;
};

} // namespace tandem
