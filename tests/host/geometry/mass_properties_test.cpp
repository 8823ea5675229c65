/* mass_properties_test.cpp - masses and tensors against closed forms, against each other, and against quadrature. */
#include <functional>

#include "host/geometry/mass_properties.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double pi = std::numbers::pi;

Eigen::Matrix3d tensor_of(const SymmetricMatrix &m)
{
  Eigen::Matrix3d result;
  result << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  return result;
}

std::array<double, 4> array_of(const Eigen::Quaterniond &q) { return {q.x(), q.y(), q.z(), q.w()}; }

/* Relative to the largest entry, and to a length for centres. */
void check_same(const MassProperties &a, const MassProperties &b, double tolerance, double length = 1)
{
  CHECK(std::abs(a.mass - b.mass) <= tolerance * std::abs(b.mass));
  CHECK((vector_of(a.center) - vector_of(b.center)).norm() <= tolerance * length);
  const Eigen::Matrix3d expected = tensor_of(b.inertia);
  CHECK((tensor_of(a.inertia) - expected).cwiseAbs().maxCoeff() <= tolerance * expected.cwiseAbs().maxCoeff());
}

MassProperties solid(double mass, double center_y, double across, double along)
{
  return {mass, {0, center_y, 0}, {across, along, across, 0, 0, 0}};
}

/* Integrates by the midpoint rule over discs of the given radius; its error falls with the square of their number. */
MassProperties summed_discs(const std::function<double(double)> &radius, double bottom, double top, int discs)
{
  const double thickness = (top - bottom) / discs;
  double mass = 0, first = 0, second = 0, along = 0;
  for (int i = 0; i < discs; ++i) {
    const double y = bottom + (i + 0.5) * thickness, r = radius(y), dm = pi * r * r * thickness;
    mass += dm;
    first += dm * y;
    second += dm * (y * y + r * r / 4);
    along += dm * r * r / 2;
  }
  return solid(mass, first / mass, second - first * first / mass, along);
}

/* The radius at y of the convex hull of two spheres at +-height / 2: the widest of the spheres between them, whose
 * centres and radii change evenly. Found by searching, so that no tangent is needed. */
double hull_of_spheres_radius(double bottom, double top, double height, double y)
{
  const auto squared = [&](double t) {
    const double offset = y - height * (t - 0.5), radius = bottom + (top - bottom) * t;
    return radius * radius - offset * offset; /* concave in t where the sides meet at less than a right angle */
  };
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double one = low + (high - low) / 3, other = high - (high - low) / 3;
    if (squared(one) < squared(other)) low = one;
    else high = other;
  }
  return std::sqrt(std::max(0.0, squared((low + high) / 2)));
}

TriangleMesh box_mesh(float x, float y, float z)
{
  return triangle_mesh(box_corners(x, y, z), box_triangles(), "test");
}

Eigen::Matrix3d recomposed(const PrincipalAxes &axes)
{
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(axes.rotation[3], axes.rotation[0], axes.rotation[1], axes.rotation[2]).toRotationMatrix();
  return turn * Eigen::Vector3d(axes.moments[0], axes.moments[1], axes.moments[2]).asDiagonal() * turn.transpose();
}

double angle_of(const PrincipalAxes &axes) { return 2 * std::acos(std::min(1.0, axes.rotation[3])); }

} // namespace

TEST_CASE("mass: sphere, box, cylinder, cone and capsule have their closed forms", "[sanitizer]")
{
  const double r = 0.7, h = 1.9;
  check_same(sphere_mass(r),
             solid(4 * pi / 3 * r * r * r, 0, 0.4 * 4 * pi / 3 * std::pow(r, 5), 0.4 * 4 * pi / 3 * std::pow(r, 5)),
             1e-15);
  check_same(box_mass({1, 2, 3}), {48, {}, {48 * 13 / 3.0, 48 * 10 / 3.0, 48 * 5 / 3.0, 0, 0, 0}}, 1e-15);
  const double disc = pi * r * r * h;
  check_same(cylinder_mass(r, r, h), solid(disc, 0, disc * (3 * r * r + h * h) / 12, disc * r * r / 2), 1e-14);
  const double cone = disc / 3;
  const MassProperties upright = solid(cone, -h / 4, cone * (3.0 / 20 * r * r + 3.0 / 80 * h * h), 0.3 * cone * r * r);
  check_same(cylinder_mass(r, 0, h), upright, 1e-14);
  check_same(cylinder_mass(0, r, h), placed(upright, {1, 0, 0, 0}, {}), 1e-14);
  const double ends = 4 * pi / 3 * r * r * r;
  const double across = disc * (h * h / 12 + r * r / 4) + ends * (0.4 * r * r + h * h / 4 + 3.0 / 8 * h * r);
  check_same(capsule_mass(r, r, h), solid(disc + ends, 0, across, disc * r * r / 2 + 0.4 * ends * r * r), 1e-14);
}

TEST_CASE("mass: a truncated cone is a cone less its tip")
{
  const double tip_height = 1.5, height = 2, radius = 1.2, small = radius * tip_height / (tip_height + height);
  MassProperties whole = placed(cylinder_mass(radius, 0, height + tip_height), {0, 0, 0, 1}, {0, tip_height / 2, 0});
  const MassProperties frustum = cylinder_mass(radius, small, height);
  const MassProperties tip =
      placed(cylinder_mass(small, 0, tip_height), {0, 0, 0, 1}, {0, (height + tip_height) / 2, 0});
  const MassProperties parts[] = {frustum, tip};
  check_same(compound_mass(parts), whole, 1e-14);
}

TEST_CASE("mass: tapered capsules agree with sums of discs of the hull of two spheres, ever better with more discs",
          "[sanitizer]")
{
  for (const auto &[bottom, top, height] :
       {std::array{1.0, 0.4, 2.0}, {0.2, 0.9, 1.1}, {0.5, 0.0, 0.8}, {0.3, 0.3, 1.0}, {1.0, 0.05, 0.96}}) {
    INFO(bottom << " " << top << " " << height);
    const double low = std::min(-height / 2 - bottom, height / 2 - top),
                 high = std::max(height / 2 + top, -height / 2 + bottom);
    const auto radius = [&](double y) { return hull_of_spheres_radius(bottom, top, height, y); };
    const MassProperties exact = capsule_mass(bottom, top, height);
    const double coarse = std::abs(summed_discs(radius, low, high, 2000).mass / exact.mass - 1);
    const double fine = std::abs(summed_discs(radius, low, high, 8000).mass / exact.mass - 1);
    CHECK(coarse < 1e-6);
    CHECK(fine < coarse / 10);
    check_same(exact, summed_discs(radius, low, high, 8000), 2e-7);
  }
}

TEST_CASE("mass: a capsule whose one sphere holds the other is that sphere, and the change is continuous")
{
  check_same(capsule_mass(1, 0.2, 0.5), placed(sphere_mass(1), {0, 0, 0, 1}, {0, -0.25, 0}), 1e-15);
  check_same(capsule_mass(0.2, 1, 0.5), placed(sphere_mass(1), {0, 0, 0, 1}, {0, 0.25, 0}), 1e-15);
  check_same(capsule_mass(1, 0.2, 0.8 + 1e-9), capsule_mass(1, 0.2, 0.8), 1e-8);
}

TEST_CASE("mass: a box as mesh or hull is the box", "[sanitizer]")
{
  check_same(mesh_mass(box_mesh(1, 2, 3), "test"), box_mass({1, 2, 3}), 1e-14);
  check_same(hull_mass(convex_hull(box_corners(1, 2, 3), "test")), box_mass({1, 2, 3}), 1e-14);
}

TEST_CASE("mass: far from the origin nothing cancels")
{
  for (float distance : {1024.0f, 1048576.0f}) {
    std::vector<Vec3> corners = box_corners(1, 2, 3); /* exact in floats there, too */
    for (Vec3 &p : corners)
      for (float &x : p) x += distance;
    const MassProperties mass = mesh_mass(triangle_mesh(corners, box_triangles(), "test"), "test");
    check_same(mass, {48, {distance, distance, distance}, box_mass({1, 2, 3}).inertia}, 1e-13);
  }
}

/* Errors c h^2 + d h^4 of edges h halved each time: their ratios tend to 4, and what they lack falls by 4 in turn. */
TEST_CASE("mass: a finer icosphere comes closer to the sphere with the square of its edges")
{
  std::vector<std::array<double, 2>> errors;
  for (int level = 0; level <= 4; ++level) {
    const Soup soup = icosphere(level);
    const MassProperties mass = mesh_mass(triangle_mesh(soup.vertices, soup.triangles, "test"), "test");
    errors.push_back({1 - mass.mass / sphere_mass(1).mass, 1 - mass.inertia.xx / sphere_mass(1).inertia.xx});
  }
  for (size_t quantity = 0; quantity < 2; ++quantity) {
    const auto lacking = [&](size_t level) { return 4 - errors[level - 1][quantity] / errors[level][quantity]; };
    for (size_t level = 2; level <= 4; ++level) CHECK(std::abs(lacking(level)) < std::abs(lacking(level - 1)) / 3);
    CHECK(std::abs(lacking(4)) < 0.05);
  }
}

TEST_CASE("mass: a turned and moved mesh has the turned tensor and the moved centre")
{
  Random random(2);
  for (int turn = 0; turn < 20; ++turn) {
    const Eigen::Quaterniond rotation = random_rotation(random);
    const std::vector<Vec3> corners = moved(box_corners(1, 2, 3), rotation, {4, -5, 6});
    const MassProperties mass = mesh_mass(triangle_mesh(corners, box_triangles(), "test"), "test");
    check_same(mass, placed(box_mass({1, 2, 3}), array_of(rotation), {4, -5, 6}),
               1e-6); /* corners are rounded to float */
  }
}

TEST_CASE("mass: halves of a box, put together, are the box, and lumps follow the parallel axes")
{
  const std::array<double, 4> none{0, 0, 0, 1};
  const MassProperties halves[] = {placed(box_mass({1, 2, 1.5}), none, {7, 8, 8}),
                                   placed(box_mass({1, 2, 1.5}), none, {7, 8, 11})};
  check_same(compound_mass(halves), placed(box_mass({1, 2, 3}), none, {7, 8, 9.5}), 1e-14);

  const MassProperties balls[] = {placed(with_mass(sphere_mass(0.5), 3), none, {1, 0, 0}),
                                  placed(with_mass(sphere_mass(0.5), 1), none, {0, 1, 0})};
  const MassProperties both = compound_mass(balls);
  const double own = 0.4 * 4 * 0.25, reduced = 3.0 / 4; /* reduced mass, at a distance of (1, -1, 0) */
  check_same(both, {4, {0.75, 0.25, 0}, {own + reduced, own + reduced, own + 2 * reduced, reduced, 0, 0}}, 1e-14);
}

TEST_CASE("mass: meshes without a volume, or inside out, are refused")
{
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Triangle> two{{0, 1, 2}, {0, 2, 3}};
  CHECK_THAT(complaint([&] { mesh_mass(triangle_mesh(square, two, "a"), "roof.glb"); }),
             ContainsSubstring("roof.glb: a flat mesh of 2 triangles has no volume"));
  const std::vector<Triangle> inside_out = turned_round(box_triangles());
  CHECK_THAT(complaint([&] { mesh_mass(triangle_mesh(box_corners(1, 1, 1), inside_out, "a"), "box.glb"); }),
             ContainsSubstring("box.glb: the volume of the mesh is -8"));
}

TEST_CASE("principal axes: the tensor is put together again, moments obey the triangle inequality", "[sanitizer]")
{
  Random random(4);
  for (int turn = 0; turn < 200; ++turn) {
    const MassProperties box = box_mass({random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)});
    const Eigen::Quaterniond rotation = random_rotation(random);
    const MassProperties turned = placed(box, array_of(rotation), {});
    const PrincipalAxes axes = principal_axes(turned.inertia);
    const Eigen::Matrix3d expected = tensor_of(turned.inertia);
    CHECK((recomposed(axes) - expected).cwiseAbs().maxCoeff() < 1e-14 * expected.trace());
    CHECK(axes.moments[0] + axes.moments[1] > axes.moments[2]);
    CHECK(axes.moments[1] + axes.moments[2] > axes.moments[0]);
    CHECK(axes.moments[2] + axes.moments[0] > axes.moments[1]);
    CHECK(axes.rotation[3] >= 0);
    CHECK(angle_of(axes) <= 62.8 * pi / 180); /* none is farther from the 24 rotations of a cube */
  }
}

TEST_CASE("principal axes: a small turn is found again, and axes already principal stay, whatever the order of moments")
{
  const Eigen::Quaterniond small(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 2).normalized()));
  const PrincipalAxes axes = principal_axes(placed(box_mass({1, 3, 2}), array_of(small), {}).inertia);
  CHECK(Eigen::Quaterniond(axes.rotation[3], axes.rotation[0], axes.rotation[1], axes.rotation[2])
            .angularDistance(small) < 1e-12);
  for (const Double3 &size : {Double3{1, 2, 3}, {3, 1, 2}, {2, 3, 1}, {1, 3, 2}}) {
    const PrincipalAxes own = principal_axes(box_mass(size).inertia);
    CHECK(own.rotation == std::array<double, 4>{0, 0, 0, 1});
    CHECK(own.moments[0] == Approx(box_mass(size).inertia.xx));
  }
}

TEST_CASE("principal axes: equal moments turn nothing that need not turn")
{
  Random random(5);
  for (int turn = 0; turn < 50; ++turn) {
    const Eigen::Quaterniond rotation = random_rotation(random);
    CHECK(principal_axes(placed(box_mass({1, 1, 1}), array_of(rotation), {}).inertia).rotation ==
          std::array<double, 4>{0, 0, 0, 1});
    for (double height : {2.0, 0.2}) { /* a rod and a disc */
      const MassProperties round = placed(cylinder_mass(0.3, 0.3, height), array_of(rotation), {});
      const PrincipalAxes axes = principal_axes(round.inertia);
      CHECK((recomposed(axes) - tensor_of(round.inertia)).cwiseAbs().maxCoeff() <
            1e-14 * tensor_of(round.inertia).trace());
      const Eigen::Vector3d along = rotation * Eigen::Vector3d::UnitY();
      CHECK(
          angle_of(axes) ==
          Approx(std::acos(along.cwiseAbs().maxCoeff())).margin(1e-7)); /* only the axis is brought onto the nearest */
    }
  }
}
