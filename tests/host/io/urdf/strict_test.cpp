/* strict_test.cpp - mistakes in URDF and MJCF files: one line each, with file and line, that says what would be right.
 * Both readers share the layer that reads XML. */
#include <fmt/format.h>

#include <tandem/load_scene.h>

#include "tests/host/io/robot_text.h"
#include "tests/tools/command/command_line.h"

using namespace tandem;
using namespace tandem::robot_text;

namespace {

std::string urdf_complaint(const std::string &inside)
{
  return complaint([&] { urdf(inside); });
}
std::string mjcf_complaint(const std::string &inside)
{
  return complaint([&] { mjcf(inside); });
}

struct Mistake {
  std::string inside, mentions;
};

const std::string base = urdf_link("base", ball), arm = urdf_link("arm", ball);

std::string joint_with(const std::string &type, const std::string &inside)
{
  return base + arm + urdf_joint("j", type, "base", "arm", inside);
}

std::string shape_of(const std::string &geometry)
{
  return urdf_link("base", inertial + "<collision><geometry>" + geometry + "</geometry></collision>");
}

std::string inertia_of_link(const std::string &mass, const std::string &moments)
{
  return urdf_link("base", "<inertial><mass value=\"" + mass + "\"/><inertia " + moments + "/></inertial>");
}

std::string geom(const std::string &attributes)
{
  return "<worldbody><body><freejoint/><geom " + attributes + "/></body></worldbody>";
}

std::string hinge(const std::string &attributes)
{
  return "<worldbody><body><joint name=\"j\" " + attributes + "/><geom size=\"1\"/></body></worldbody>";
}

std::string nested(const std::string &element, int times)
{
  std::string text;
  for (int k = 0; k < times; ++k) text += "<" + element + ">";
  for (int k = 0; k < times; ++k) text += "</" + element + ">";
  return text;
}

} // namespace

TEST_CASE("urdf, strictly: trees of links", "[address]")
{
  const std::string joint = urdf_joint("j", "fixed", "base", "arm");
  for (const auto &[inside, mentions] : std::vector<Mistake>{
           {"", "<link> is missing"},
           {"<link/>", "name is missing"},
           {base + base, "line 1 has a link of that name"},
           {base + arm, "as link \"base\" has none; one root is needed"},
           {base + arm + joint + joint, "line 1 has a joint of that name"},
           {base + arm + joint + urdf_joint("k", "fixed", "base", "arm"), "has a parent by the joint in line 1"},
           {base + urdf_joint("j", "fixed", "base", "gone"), "link \"gone\" does not exist"},
           {base + urdf_joint("j", "fixed", "base", "base"), "with itself"},
           {base + arm + "<joint name=\"j\" type=\"fixed\"><child link=\"arm\"/></joint>", "<parent> is missing"},
           {base + arm + joint + urdf_joint("k", "fixed", "arm", "base"), "in a loop"},
           {base + arm + urdf_link("a", ball) + urdf_link("b", ball) + joint + urdf_joint("k", "fixed", "a", "b") +
                urdf_joint("l", "fixed", "b", "a"),
            "is in a loop of joints"},
           {joint_with("continuous", "<mimic joint=\"gone\"/>"), "joint \"gone\" does not exist"},
           {joint_with("continuous", "<mimic joint=\"j\"/>"), "joint \"j\" follows itself"},
           {urdf_link("world", ""), "there is nothing to simulate"}}) {
    CAPTURE(inside);
    check_one_line(urdf_complaint(inside), urdf_path + ": line 1: ", mentions);
  }
}

TEST_CASE("urdf, strictly: joints", "[address]")
{
  for (const auto &[inside, mentions] : std::vector<Mistake>{
           {joint_with("screw", ""), "type is \"screw\""},
           {joint_with("revolute", ""), "<limit> is missing"},
           {joint_with("continuous", "<axis xyz=\"0 0 0\"/>"), "xyz is 0 0 0"},
           {joint_with("continuous", "<axis xyz=\"0 1\"/>"), "xyz has 2 numbers; 3 are needed"},
           {joint_with("continuous", "<axis xyz=\"0 nan 1\"/>"), "\"nan\" is no finite number"},
           {joint_with("continuous", "<origin xyz=\"1e400 0 0\"/>"), "\"1e400\" is no finite number"},
           {joint_with("continuous", "<origin xyz=\"1e30 0 0\"/>"), "beyond 1e18"},
           {joint_with("continuous", "<origin rpy=\"1e7 0 0\"/>"), "at most 1e6 rad"},
           {joint_with("continuous", "<axis/><axis/>"), "a second one in <joint>"},
           {joint_with("prismatic", "<limit lower=\"1\" upper=\"-1\"/>"), "limits from 1 to -1"},
           {joint_with("revolute", "<limit lower=\"4\" upper=\"5\"/>"), "angles count from -pi to pi"},
           {joint_with("prismatic", "<limit effort=\"-1\"/>"), "effort is -1; at least 0 is needed"},
           {joint_with("continuous", "<dynamics damping=\"-1\"/>"), "damping is -1; at least 0 is needed"}}) {
    CAPTURE(inside);
    check_one_line(urdf_complaint(inside), urdf_path + ": line 1: ", mentions);
  }
}

TEST_CASE("urdf, strictly: masses and shapes", "[address]")
{
  const std::string moments = R"(ixx="1" iyy="1" izz="1")";
  for (const auto &[inside, mentions] : std::vector<Mistake>{
           {inertia_of_link("-1", moments), "value is -1 kg"},
           {inertia_of_link("nan", moments), "\"nan\" is no finite number"},
           {inertia_of_link("1", R"(ixx="1" iyy="1" izz="3")"), "at most the sum of the others"},
           {inertia_of_link("1", R"(ixx="1" iyy="1" izz="0")"), "must be above 0"},
           {inertia_of_link("1", R"(ixx="1" iyy="1" izz="1" ixy="2")"), "must be above 0"},
           {inertia_of_link("1", R"(ixx="1" iyy="1")"), "izz is missing"},
           {urdf_link("base", "<inertial/>"), "<mass> is missing"},
           {shape_of(""), "one shape is needed"},
           {shape_of("<box/>"), "size is missing"},
           {shape_of("<box size=\"1 -1 1\"/>"), "half of a size is -0.5 m; more than 0"},
           {shape_of("<sphere radius=\"0\"/>"), "radius is 0 m; more than 0"},
           {shape_of("<sphere radius=\"1e-60\"/>"), "more than 0"},
           {shape_of("<cylinder radius=\"1\" length=\"1e12\"/>"), "at most 1e+09"},
           {shape_of("<sphere radius=\"0x1\"/>"), "\"0x1\" is no finite number"},
           {shape_of("<mesh/>"), "filename is missing"},
           {shape_of("<plane/>"), "moves and has a plane"},
           {base + urdf_link("a", "") + urdf_link("b", ball) + arm + urdf_joint("j", "continuous", "base", "a") +
                urdf_joint("k", "continuous", "a", "b") + urdf_joint("l", "continuous", "a", "arm"),
            "has no mass and 2 links that move on it"}}) {
    CAPTURE(inside);
    check_one_line(urdf_complaint(inside), urdf_path + ": line 1: ", mentions);
  }
}

TEST_CASE("mjcf, strictly: classes, geoms and bodies", "[address]")
{
  for (const auto &[inside, mentions] : std::vector<Mistake>{
           {"", "there is nothing to simulate"},
           {"<include file=\"other.xml\"/>", "other files are not included"},
           {"<worldbody><include file=\"other.xml\"/></worldbody>", "other files are not included"},
           {"<compiler angle=\"grad\"/>", "angle is \"grad\"; one of degree, radian is needed"},
           {"<compiler coordinate=\"global\"/>", "coordinate is \"global\""},
           {"<compiler eulerseq=\"xyw\"/>", "eulerseq is no three letters"},
           {"<compiler autolimits=\"yes\"/>", "true or false is needed"},
           {"<default class=\"x\"/>", "the outermost is \"main\""},
           {"<default><default/></default>", "class is missing"},
           {"<default><default class=\"x\"/><default class=\"x\"/></default>", "stands twice"},
           {geom("class=\"gone\""), "class \"gone\" does not exist"},
           {geom(""), "size has 0 numbers; 1 are needed"},
           {geom("size=\"-1\""), "a size is -1 m"},
           {geom("type=\"box\" size=\"1 1\""), "size has 2 numbers; 3 are needed"},
           {geom("type=\"star\" size=\"1\""), "type is \"star\""},
           {geom("type=\"capsule\" size=\"1\" fromto=\"1 1 1 1 1 1\""), "fromto is 0 0 0"},
           {geom("type=\"plane\" size=\"1 1 1\" "), "moves and has a plane"},
           {geom("type=\"mesh\" mesh=\"gone\""), "mesh \"gone\" does not exist"},
           {geom("size=\"1\" mass=\"-1\""), "mass is -1; at least 0"},
           {geom("size=\"1\" friction=\"-1\""), "friction is -1"},
           {geom("size=\"1\" condim=\"2\""), "condim is 2"},
           {geom("size=\"1\" contype=\"0.5\""), "a whole number of 32 bits"},
           {geom("size=\"1\" quat=\"0 0 0 0\""), "quat is 0"},
           {geom("size=\"1\" quat=\"1 0 0 0\" euler=\"0 0 0\""), "not several"},
           {geom("size=\"1\" xyaxes=\"1 0 0 2 0 0\""), "xyaxes are parallel"},
           {"<asset><mesh name=\"m\"/></asset>" + geom("type=\"mesh\" mesh=\"m\""), "file or vertex is missing"},
           {"<asset><mesh/></asset>", "name or file is missing"},
           {"<asset><mesh name=\"m\" vertex=\"0 0 0 1 0 0 0 1 0 1 1 0\"/></asset>" + geom("type=\"mesh\" mesh=\"m\""),
            "name=\"m\""},
           {"<asset><mesh name=\"m\" file=\"m.obj\"/></asset>" + geom("type=\"mesh\" mesh=\"m\""), "cannot read"},
           {"<asset><mesh name=\"m\" file=\"../m.obj\"/></asset>" + geom("type=\"mesh\" mesh=\"m\""),
            "outside the folder"},
           {"<worldbody><joint/></worldbody>", "the world has no joints"},
           {"<worldbody><replicate count=\"1e9\"><geom size=\"1\"/></replicate></worldbody>", "count is 1e+09"},
           {"<worldbody><replicate count=\"9999\"><replicate count=\"9999\"><geom size=\"1\"/></replicate></replicate>"
            "</worldbody>",
            "more than 100000 bodies"},
           {"<worldbody><body name=\"a\"/><body name=\"a\"/></worldbody>", "a body of that name stands before"},
           {"<worldbody><body><body><freejoint/><geom size=\"1\"/></body></body></worldbody>", "does not float"},
           {"<worldbody><body><joint/></body><body><inertial mass=\"1\"/></body></worldbody>",
            "diaginertia or fullinertia"},
           {"<worldbody><body><freejoint/><inertial mass=\"1\" diaginertia=\"1 1 3\"/></body></worldbody>",
            "at most the sum of the others"}}) {
    CAPTURE(inside);
    check_one_line(mjcf_complaint(inside), mjcf_path + ": line 1: ", mentions);
  }
}

TEST_CASE("mjcf, strictly: joints, actuators, equalities and exclusions", "[address]")
{
  for (const auto &[inside, mentions] : std::vector<Mistake>{
           {hinge("type=\"screw\""), "type is \"screw\""},
           {hinge("axis=\"0 0 0\""), "axis is 0 0 0"},
           {hinge("range=\"1\""), "range has 1 numbers"},
           {hinge("range=\"2 1\""), "range is from 2 to 1"},
           {hinge("limited=\"true\""), "limited is true, and range is missing"},
           {hinge("limited=\"maybe\" range=\"0 1\""), "true or false is needed"},
           {hinge("stiffness=\"-1\""), "stiffness is -1"},
           {hinge("/><freejoint"), "a body that floats has no others"},
           {hinge("/><joint name=\"j\""), "a joint of that name stands before"},
           {hinge("") + "<actuator><motor joint=\"gone\"/></actuator>", "joint \"gone\" does not exist"},
           {hinge("") + "<actuator><position joint=\"j\" kp=\"-2\"/></actuator>", "kp is -2"},
           {hinge("") + "<actuator><position joint=\"j\" ctrllimited=\"true\"/></actuator>", "ctrlrange is missing"},
           {hinge("") + "<equality><weld body1=\"gone\"/></equality>", "body \"gone\" does not exist"},
           {hinge("") + "<equality><connect body1=\"world\"/></equality>", "anchor is missing"},
           {hinge("") + "<equality><joint joint1=\"gone\" joint2=\"j\"/></equality>", "joint \"gone\" does not exist"},
           {hinge("") + "<equality><joint joint1=\"j\" polycoef=\"4\"/></equality>",
            "has an offset of 4; at most 3.14"},
           {hinge("armature=\"-1\""), "armature is -1"},
           {hinge("/><joint name=\"k\" axis=\"1 0 0\"") +
                "<equality><joint joint1=\"j\" joint2=\"k\" polycoef=\"0 1e9\"/></equality>",
            "follows by a factor of 1e+09"},
           {hinge("") + "<contact><exclude body1=\"gone\" body2=\"world\"/></contact>",
            "body \"gone\" does not exist"}}) {
    CAPTURE(inside);
    check_one_line(mjcf_complaint(inside), mjcf_path + ": line 1: ", mentions);
  }
}

TEST_CASE("xml, strictly: what is no XML, no text or no robot, is refused by its line", "[address]")
{
  const auto said = [](const std::string &text) { return complaint([&] { parse_scene_urdf(text, urdf_path); }); };
  const std::string whole = "<robot name=\"r\">\n" + base + "\n</robot>";
  for (size_t size = 0; size < whole.size(); ++size)
    CHECK(said(whole.substr(0, size)).find(urdf_path + ": line ") == 0);
  CHECK(said(whole).empty());
  check_one_line(said(""), urdf_path, "an XML file is needed");
  check_one_line(said("<robot>\n\n</link>"), urdf_path + ": line ", "closed");
  check_one_line(said("<robot name=\"a\" name=\"b\"/>"), urdf_path + ": line 1: ", "malformed XML");
  check_one_line(said("<robot>\n\xff</robot>"), urdf_path + ": line 2: ", "no UTF-8");
  check_one_line(said(std::string("<robot>\n\0</robot>", 17)), urdf_path + ": line 2: ", "a byte of 0");
  check_one_line(said("<sdf/>"), urdf_path + ": line 1: ", "is no <robot>");
  check_one_line(complaint([] { parse_scene_mjcf("<robot/>", mjcf_path); }), mjcf_path, "name the file .urdf");
  check_one_line(said("<robot>" + nested("link", 10'000) + "</robot>"), urdf_path, "some hundred deep");
  check_one_line(mjcf_complaint(nested("body", 10'000)), mjcf_path, "some hundred deep");
}

TEST_CASE("xml, strictly: references to what is no character are refused, and others are read", "[address]")
{
  const auto read = [](const std::string &name) {
    return parse_scene_urdf("<robot>\n<!-- &#0; --><link name=\"" + name + "\">" + ball + "</link></robot>", urdf_path);
  };
  for (const char *wrong :
       {"&#0;", "&#x0;", "&#xD800;", "&#57343;", "&#x110000;", "&#99999999999;", "&#;", "&#xq;", "&#-5;"}) {
    CAPTURE(wrong);
    check_one_line(complaint([&] { read(std::string("a") + wrong + "b"); }),
                   urdf_path + ": line 2: ", std::string("\"") + wrong + "\" is no character");
  }
  CHECK(read("&#x41;&#98;&#xe4;&#x10ffff;").bodies[0].name == "Ab\xc3\xa4\xf4\x8f\xbf\xbf");
}

/* Each of these would take minutes or all memory if it were read to its end. */
TEST_CASE("urdf and mjcf, strictly: small files that ask for much are refused", "[address]")
{
  std::string links = base, elements, classes, contents;
  for (int k = 0; k < 60; ++k)
    links += urdf_link(fmt::format("l{}", k), "") + urdf_joint(fmt::format("j{}", k), "continuous",
                                                               k == 0 ? "base" : fmt::format("l{}", k - 1),
                                                               fmt::format("l{}", k));
  links += arm + urdf_joint("last", "continuous", "l59", "arm");
  check_one_line(urdf_complaint(links), urdf_path + ": line 1: ", "has no mass, and so have those before it");
  for (int k = 0; k < 1200; ++k) {
    elements += fmt::format("<e{} a=\"1\"/>", k);
    classes += fmt::format("<default class=\"c{}\"/>", k);
    contents += "<unknown/>";
  }
  check_one_line(mjcf_complaint("<default>" + elements + classes + "</default>"),
                 mjcf_path + ": line 1: ", "more than 1000000 attributes");
  check_one_line(mjcf_complaint("<worldbody><replicate count=\"9999\">" + contents + "</replicate></worldbody>"),
                 mjcf_path + ": line 1: ", "more than 1000000 elements");
}

/* tinyxml2 reads no document types, so an entity stays as it is written and nothing grows. */
TEST_CASE("xml, strictly: entities are not expanded", "[address]")
{
  std::string text = "<!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (char name = 'b'; name <= 'z'; ++name)
    text += fmt::format("<!ENTITY {} \"&{};&{};&{};&{};&{};\">", name, char(name - 1), char(name - 1), char(name - 1),
                        char(name - 1), char(name - 1));
  text += "]><robot name=\"r\"><link name=\"&z;\">" + ball + "</link></robot>";
  const std::string said = complaint([&] {
    const Scene scene = parse_scene_urdf(text, urdf_path);
    CHECK(scene.bodies.at(0).name == "&z;");
  });
  INFO(said);
  CHECK((said.empty() || said.find(urdf_path + ": line ") == 0));
}

TEST_CASE("urdf, strictly: meshes that leave the folder or are damaged are refused", "[address]")
{
  const command_line::Scratch folder;
  std::filesystem::create_directories(folder.path / "inside");
  std::ofstream(folder.file("outside.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n";
  std::ofstream(folder.path / "inside" / "cut.stl") << std::string(83, ' ') << "\1\1";
  std::ofstream(folder.path / "inside" / "flat.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n";
  const std::string path = (folder.path / "inside" / "robot.urdf").string();
  const auto said = [&](const std::string &name, OutsideFiles outside = OutsideFiles::refused) {
    const std::string text = "<robot>" + shape_of("<mesh filename=\"" + name + "\"/>") + "</robot>";
    return complaint([&] { parse_scene_urdf(text, path, outside); });
  };
  for (const std::string &name :
       {std::string("../outside.obj"), folder.file("outside.obj"), "file://" + folder.file("outside.obj"),
        std::string("package://x/../../outside.obj"), std::string("package:///etc/hosts.obj")})
    check_one_line(said(name),
                   path + ": line 1: ", name.find("hosts") == std::string::npos ? "outside the folder" : "");
  CHECK(said("../outside.obj", OutsideFiles::allowed).empty());
  check_one_line(said("cut.stl"), path + ": line 1: ", "triangles need");
  check_one_line(said("flat.obj"), path + ": line 1: ", "flat.obj");
}
