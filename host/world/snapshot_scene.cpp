/* snapshot_scene.cpp - see snapshot_scene.h. */
#include "host/world/snapshot_scene.h"

#include <map>

#include "host/world/snapshot_fields.h"

namespace tandem {
namespace {

constexpr uint32_t no_table = 0xffffffffu;

/* A shape with numbers in place of its pointers. */
struct StoredShape {
  ShapeType type{};
  Vec3 size{};
  uint32_t hull = no_table, mesh = no_table, compound = no_table;
};

struct StoredChild {
  StoredShape shape;
  Vec3 position{};
  Quat orientation{};
  float density = 0;
  std::optional<uint32_t> material, filter_group, filter_mask;
};

template <Is<StoredShape> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[type, size, hull, mesh, compound] = record;
  return visit(type, size, hull, mesh, compound);
}

template <Is<StoredChild> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[shape, position, orientation, density, material, filter_group, filter_mask] = record;
  return visit(shape, position, orientation, density, material, filter_group, filter_mask);
}

/* --- writing ------------------------------------------------------------------------------------------------------ */

/* The distinct hulls, meshes and compounds of shapes. A compound comes after all that its children use. */
class ShapeTables {
public:
  StoredShape add(const Shape &shape)
  {
    const auto &[type, size, hull, mesh, compound] = shape;
    if (compound && !compounds_.numbers.contains(compound.get()))
      for (const Child &child : compound->children) add(child.shape);
    return {type, size, hulls_.add(hull.get()), meshes_.add(mesh.get()), compounds_.add(compound.get())};
  }
  void put(ByteWriter &writer)
  {
    hulls_.put(writer);
    meshes_.put(writer);
    writer.put(uint64_t{compounds_.all.size()});
    for (const Compound *compound : compounds_.all) {
      const auto &[children] = *compound;
      std::vector<StoredChild> stored;
      for (const Child &child : children) {
        const auto &[shape, position, orientation, density, material, filter_group, filter_mask] = child;
        stored.push_back({add(shape), position, orientation, density, material, filter_group, filter_mask});
      }
      writer.put(stored);
    }
  }

private:
  template <class T> struct Table {
    std::map<const T *, uint32_t> numbers;
    std::vector<const T *> all;

    uint32_t add(const T *one)
    {
      if (!one) return no_table;
      const auto [at, is_new] = numbers.emplace(one, static_cast<uint32_t>(all.size()));
      if (is_new) all.push_back(one);
      return at->second;
    }
    void put(ByteWriter &writer) const
    {
      writer.put(uint64_t{all.size()});
      for (const T *one : all) writer.put(*one);
    }
  };

  Table<ConvexHull> hulls_;
  Table<TriangleMesh> meshes_;
  Table<Compound> compounds_;
};

/* --- reading ------------------------------------------------------------------------------------------------------ */

template <class Indices>
void check_indices(const ByteReader &reader, const char *what, const Indices &indices, size_t count, bool may_be_none)
{
  for (const uint32_t index : indices)
    if (index >= count && !(may_be_none && index == no_triangle))
      reader.fail(fmt::format("{} {} does not exist; there are {}", what, index, count));
}

void check(const ByteReader &reader, const ConvexHull &hull)
{
  const size_t vertices = hull.vertices.size(), faces = hull.faces.size();
  if (hull.planes.size() != faces)
    reader.fail(fmt::format("a hull has {} faces and {} planes", faces, hull.planes.size()));
  for (const auto &face : hull.faces) {
    if (face.size() < 3) reader.fail(fmt::format("a face of a hull has {} corners", face.size()));
    check_indices(reader, "vertex", face, vertices, false);
  }
  for (const HullEdge &edge : hull.edges) {
    check_indices(reader, "vertex", std::array{edge.v0, edge.v1}, vertices, false);
    check_indices(reader, "face", std::array{edge.face_left, edge.face_right}, faces, false);
  }
}

void check(const ByteReader &reader, const TriangleMesh &mesh)
{
  const size_t triangles = mesh.triangles.size();
  if (triangles == 0 || mesh.neighbours.size() != triangles || mesh.triangle_edges.size() != triangles)
    reader.fail(fmt::format("a mesh has {} triangles, with neighbours of {} and edges of {}", triangles,
                            mesh.neighbours.size(), mesh.triangle_edges.size()));
  for (const Triangle &triangle : mesh.triangles)
    check_indices(reader, "vertex", triangle, mesh.vertices.size(), false);
  for (const auto &neighbours : mesh.neighbours) check_indices(reader, "triangle", neighbours, triangles, true);
  for (const auto &edges : mesh.triangle_edges) check_indices(reader, "edge", edges, mesh.edges.size(), false);
  for (const MeshEdge &edge : mesh.edges) {
    check_indices(reader, "vertex", std::array{edge.v0, edge.v1}, mesh.vertices.size(), false);
    check_indices(reader, "triangle", std::array{edge.left, edge.right}, triangles, true);
    if (edge.kind > EdgeKind::boundary) reader.fail("an edge of a mesh is of no kind");
  }
}

class ReadTables {
public:
  explicit ReadTables(ByteReader &reader) : reader_(reader)
  {
    read(hulls_);
    read(meshes_);
    const auto count = reader.get<uint64_t>();
    for (uint64_t k = 0; k < count; ++k) compounds_.push_back(std::make_shared<const Compound>(read_compound()));
  }
  Shape shape_of(const StoredShape &stored) const
  {
    return {stored.type, stored.size, at(hulls_, "hull", stored.hull), at(meshes_, "mesh", stored.mesh),
            at(compounds_, "compound", stored.compound)};
  }

private:
  template <class T> void read(std::vector<std::shared_ptr<const T>> &table)
  {
    const auto count = reader_.get<uint64_t>();
    for (uint64_t k = 0; k < count; ++k) {
      auto one = std::make_shared<T>();
      reader_.get(*one);
      check(reader_, *one);
      table.push_back(std::move(one));
    }
  }
  Compound read_compound()
  {
    Compound compound;
    for (const StoredChild &stored : reader_.get<std::vector<StoredChild>>())
      compound.children.push_back({shape_of(stored.shape), stored.position, stored.orientation, stored.density,
                                   stored.material, stored.filter_group, stored.filter_mask});
    return compound;
  }
  template <class T>
  std::shared_ptr<const T> at(const std::vector<std::shared_ptr<const T>> &table, const char *what,
                              uint32_t number) const
  {
    if (number == no_table) return nullptr;
    if (number >= table.size())
      reader_.fail(fmt::format("{} {} does not exist; there are {}", what, number, table.size()));
    return table[number];
  }

  ByteReader &reader_;
  std::vector<std::shared_ptr<const ConvexHull>> hulls_;
  std::vector<std::shared_ptr<const TriangleMesh>> meshes_;
  std::vector<std::shared_ptr<const Compound>> compounds_;
};

void put_shapes(ByteWriter &writer, std::span<const Shape> shapes)
{
  ShapeTables tables;
  std::vector<StoredShape> stored;
  for (const Shape &shape : shapes) stored.push_back(tables.add(shape));
  tables.put(writer);
  writer.put(stored);
}

std::vector<Shape> get_shapes(ByteReader &reader)
{
  const ReadTables tables(reader);
  std::vector<Shape> shapes;
  for (const StoredShape &stored : reader.get<std::vector<StoredShape>>()) shapes.push_back(tables.shape_of(stored));
  return shapes;
}

} // namespace

void put_scene(ByteWriter &writer, const Scene &scene)
{
  const auto &[name, gravity, shapes, materials, bodies, joints, couplings, articulations, actuators, notes] = scene;
  writer.put(name);
  writer.put(gravity);
  put_shapes(writer, shapes);
  writer.put(materials);
  writer.put(bodies);
  writer.put(joints);
  writer.put(couplings);
  writer.put(articulations);
  writer.put(actuators);
}

Scene get_scene(ByteReader &reader)
{
  Scene scene;
  auto &[name, gravity, shapes, materials, bodies, joints, couplings, articulations, actuators, notes] = scene;
  reader.get(name);
  reader.get(gravity);
  shapes = get_shapes(reader);
  reader.get(materials);
  reader.get(bodies);
  reader.get(joints);
  reader.get(couplings);
  reader.get(articulations);
  reader.get(actuators);
  validate(scene, reader.where());
  return scene;
}

void put_shape(ByteWriter &writer, const Shape &shape) { put_shapes(writer, std::span(&shape, 1)); }

Shape get_shape(ByteReader &reader)
{
  const std::vector<Shape> shapes = get_shapes(reader);
  if (shapes.size() != 1) reader.fail(fmt::format("{} shapes; one is needed", shapes.size()));
  return shapes.front();
}

/* As the children of one compound. */
void put_children(ByteWriter &writer, std::span<const Child> children)
{
  writer.put(!children.empty());
  if (!children.empty()) put_shape(writer, compound_shape({children.begin(), children.end()}));
}

std::vector<Child> get_children(ByteReader &reader)
{
  if (!reader.get<bool>()) return {};
  const Shape shape = get_shape(reader);
  if (!shape.compound) reader.fail("the shapes of a call are no list");
  return shape.compound->children;
}

} // namespace tandem
