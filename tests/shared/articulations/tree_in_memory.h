/* tree_in_memory.h - a tree of tree_model.h in the tables of shared/articulations/, in whichever precision includes
 * this within a namespace, and what the tests ask of it. */
#include "shared/articulations/dense.h"
#include "shared/articulations/inverse_dynamics.h"
#include "shared/articulations/path.h"
#include "shared/articulations/substep.h"
#include "shared/platform.h"

/* Beside each other lie `stride` trees of one model, of which this is number `item`. */
class Tree {
public:
  explicit Tree(const tree_tests::TreeModel &model, uint stride = 1, uint item = 0) : model_(model)
  {
    const size_t links = model.links.size() * stride;
    code_.resize(links);
    next_.resize(links);
    freedom_.resize(links * PATH_WORDS);
    path_.resize(links * PATH_ENTRY_ROWS * entries());
    change_.resize(size_t{stride} * TREE_FREEDOMS);
    link_.resize(links * LINK_ROWS);
    range_.resize(links);
    state_.resize(links * STATE_ROWS);
    work_.resize(links * WORK_ROWS);
    root_.resize(stride * ROOT_ROWS);
    for (uint i = 0; i < stride; ++i) fill(articulation_of(stride, i));
    t = articulation_of(stride, item);
  }

  articulation articulation_of(uint stride, uint item)
  {
    return {code_.data(),
            link_.data(),
            range_.data(),
            state_.data(),
            root_.data(),
            work_.data(),
            next_.data(),
            freedom_.data(),
            path_.data(),
            change_.data(),
            {item, stride},
            0u,
            0u,
            uint(model_.links.size()),
            0u,
            uint(entries()),
            entries() > 0 ? uint(model_.size()) : 0u,
            item,
            uint(model_.links.size())};
  }

  /* The freedoms of the longest path, of a tree that has few enough of them. */
  size_t entries() const
  {
    size_t most = 1;
    for (size_t k = 0; k < model_.links.size(); ++k) most = std::max(most, model_.path_of(k).size());
    return model_.size() <= int(TREE_FREEDOMS) ? most : 0;
  }

  void set(const tree_tests::TreeState &s)
  {
    for (uint k = 0; k < t.links; ++k) {
      const Eigen::Vector4d &q = s.q[k];
      store_state(1, &t, k, STATE_JOINT_POSITION, make_vec4(real(q[0]), real(q[1]), real(q[2]), real(q[3])));
    }
    const tree_tests::Vector high = s.root.template cast<memory_real>().template cast<double>();
    store_root(1, &t, ROOT_POSITION, extend(vector(high), 0));
    store_root(1, &t, ROOT_POSITION + 1, extend(vector(s.root - high), 0));
    set_numbers(STATE_JOINT_VELOCITY, ROOT_LINEAR_VELOCITY, s.v);
  }
  tree_tests::TreeState get() const
  {
    tree_tests::TreeState s = tree_tests::rest_of(model_);
    for (uint k = 0; k < t.links; ++k) {
      const vec4 q = load_state(&t, k, STATE_JOINT_POSITION);
      s.q[k] = Eigen::Vector4d(q.x, q.y, q.z, q.w);
    }
    s.root = eigen(xyz(load_root(&t, ROOT_POSITION))) + eigen(xyz(load_root(&t, ROOT_POSITION + 1)));
    s.v = numbers(STATE_JOINT_VELOCITY, ROOT_LINEAR_VELOCITY);
    return s;
  }
  void set_joint_forces(const tree_tests::Column &f) { set_numbers(STATE_JOINT_FORCE, ROOT_LINEAR_FORCE, f); }
  /* Six numbers a link: moment, force. */
  void set_outer_forces(const tree_tests::Column &f)
  {
    for (uint k = 0; k < t.links; ++k) {
      store_state(1, &t, k, STATE_MOMENT, extend(vector(f.segment<3>(6 * k)), 0));
      store_state(1, &t, k, STATE_FORCE, extend(vector(f.segment<3>(6 * k + 3)), 0));
    }
  }
  tree_tests::Column numbers(uint row, uint root_row) const
  {
    tree_tests::Column v(model_.size());
    for (uint k = 0; k < t.links; ++k) {
      const tree_tests::Vector x = eigen(xyz(load_state(&t, k, row)));
      for (int n = 0; n < model_.freedoms(k) && n < 3; ++n) v[model_.first(k) + n] = x[n];
      if (model_.freedoms(k) == 6) v.segment<3>(model_.first(k) + 3) = eigen(xyz(load_root(&t, root_row)));
    }
    return v;
  }
  void set_numbers(uint row, uint root_row, const tree_tests::Column &v)
  {
    for (uint k = 0; k < t.links; ++k) {
      tree_tests::Vector x = tree_tests::Vector::Zero();
      for (int n = 0; n < model_.freedoms(k) && n < 3; ++n) x[n] = v[model_.first(k) + n];
      store_state(1, &t, k, row, extend(vector(x), 0));
      if (model_.freedoms(k) == 6) store_root(1, &t, root_row, extend(vector(v.segment<3>(model_.first(k) + 3)), 0));
    }
  }
  /* WORK_PENDING as numbers of the joints, and back. */
  void set_pending(const tree_tests::Column &v)
  {
    for (uint k = 0; k < t.links; ++k) {
      tree_tests::Vector first = tree_tests::Vector::Zero(), second = first;
      for (int n = 0; n < model_.freedoms(k); ++n) (n < 3 ? first : second)[n % 3] = v[model_.first(k) + n];
      store_force(1, &t, k, WORK_PENDING, {vector(first), vector(second)});
    }
  }
  tree_tests::Column pending() const
  {
    tree_tests::Column v(model_.size());
    for (uint k = 0; k < t.links; ++k) {
      const spatial_force f = load_force(&t, k, WORK_PENDING);
      for (int n = 0; n < model_.freedoms(k); ++n) v[model_.first(k) + n] = eigen(n < 3 ? f.moment : f.force)[n % 3];
    }
    return v;
  }

  /* The accelerations of the joints, as both parts of a substep find them. */
  tree_tests::Column acceleration()
  {
    const tree_tests::TreeState before = get();
    prepare_tree(&t, 0);
    load_inertial_forces(&t, 1);
    push_links(&t);
    settle_tree(&t);
    const tree_tests::Column inertial = get().v - before.v;
    set(before);
    accelerate_tree(&t, vector(model_.gravity), 1);
    const tree_tests::Column outer = get().v - before.v;
    set(before);
    prepare_tree(&t, 0);
    return inertial + outer;
  }

  void prepare(double h) { prepare_tree(&t, real(h)); }
  void advance(double h, uint has_rows = 0)
  {
    Parameters p{};
    p.step = p.substep = memory_real(h);
    p.inverse_substep = memory_real(1 / h);
    p.joint_bias_rate = memory_real(0.2 / h);
    p.joint_mass_scale = memory_real(0.9);
    p.joint_impulse_scale = memory_real(0.1);
    advance_tree(&p, &t, vector(model_.gravity), has_rows);
  }
  void run(double time, int steps, uint has_rows = 0)
  {
    prepare(time / steps);
    for (int k = 0; k < steps; ++k) advance(time / steps, has_rows);
  }

  static vec3 vector(const tree_tests::Vector &v) { return make_vec3(real(v[0]), real(v[1]), real(v[2])); }
  static tree_tests::Vector eigen(vec3 v) { return {double(v.x), double(v.y), double(v.z)}; }

  articulation t;

private:
  static float4 row(double x, double y, double z, double w)
  {
    return {memory_real(x), memory_real(y), memory_real(z), memory_real(w)};
  }
  static float4 row(const tree_tests::Vector &v, double w) { return row(v[0], v[1], v[2], w); }
  static float4 row(const tree_tests::Turn &q) { return row(q.x(), q.y(), q.z(), q.w()); }

  void fill(const articulation &a)
  {
    for (uint k = 0; k < a.links; ++k) {
      const tree_tests::LinkModel &l = model_.links[k];
      code_[tree_row(&a, 1, k, 0)] = (l.parent < 0 ? LINK_NO_PARENT : uint(l.parent)) | uint(l.joint)
                                                                                            << LINK_JOINT_SHIFT;
      fill_freedoms(a, k);
      const auto at = [&](uint r) -> float4 & { return link_[tree_row(&a, LINK_ROWS, k, r)]; };
      const bool implicit = (l.stiffness > 0 || l.damping > 0) && !(l.largest_force < tree_tests::infinite);
      at(LINK_FRAME_A) = row(l.from_parent, l.armature);
      at(LINK_FRAME_A_ORIENTATION) = row(l.axes_in_parent);
      at(LINK_FRAME_B) = row(l.from_center, l.mass);
      at(LINK_FRAME_B_ORIENTATION) = row(l.axes_in_link);
      at(LINK_MOMENTS) = row(l.moments, implicit);
      at(LINK_AXIS) = row(l.stiffness, l.damping, l.largest_force, l.friction);
      at(LINK_AXIS + 1) = row(0, 0, tree_tests::infinite, 0);
      range_[tree_row(&a, 1, k, 0)] = row(l.lower, l.upper, l.target, l.target_speed);
    }
  }

  void fill_freedoms(const articulation &a, uint k)
  {
    const auto word = [&](uint n) -> uint & { return freedom_[tree_row(&a, PATH_WORDS, k, n)]; };
    const std::vector<int> path = model_.path_of(k);
    if (entries() > 0)
      for (const int freedom : path) word(PATH_BITS + uint(freedom) / 32) |= 1u << uint(freedom) % 32;
    word(PATH_FIRST_ENTRY) = uint(path.size()) - uint(model_.freedoms(k));
    word(PATH_FIRST_FREEDOM) = uint(model_.first(k));
  }

  const tree_tests::TreeModel model_;
  std::vector<uint> code_, next_, freedom_;
  std::vector<float4> link_, range_, state_, root_, work_, path_;
  std::vector<memory_real> change_;
};
