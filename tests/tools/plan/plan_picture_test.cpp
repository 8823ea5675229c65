/* The picture of a plan: well-formed XML whatever the names are, each box once on either side, nothing beside the
 * sheet. */
#ifdef TANDEM_COMMAND
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tools/plan/plan_picture.h"

using namespace tandem;

namespace {

struct Element {
  std::string name, text; /* text: of the element itself */
  std::map<std::string, std::string> attributes;
};

/* Reads XML without comments, declarations or CDATA, and accepts nothing that is not well-formed. */
class StrictXml {
public:
  explicit StrictXml(const std::string &text) : text_(text)
  {
    element();
    while (at_ < text_.size()) REQUIRE(std::isspace(text_[at_++]));
  }
  std::vector<Element> elements; /* in the order of their ends */

private:
  char next()
  {
    REQUIRE(at_ < text_.size());
    return text_[at_++];
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void expect(const std::string &what)
  {
    REQUIRE(text_.compare(at_, what.size(), what) == 0);
    at_ += what.size();
  }
  std::string name()
  {
    std::string word;
    while (std::isalnum(peek()) || peek() == '-' || peek() == ':') word += next();
    REQUIRE_FALSE(word.empty());
    return word;
  }
  std::string character()
  {
    const char c = next();
    REQUIRE((static_cast<unsigned char>(c) >= 0x20 || c == '\n'));
    REQUIRE(c != '<');
    if (c != '&') return std::string(1, c);
    static const std::map<std::string, std::string> known = {
        {"amp", "&"}, {"lt", "<"}, {"gt", ">"}, {"quot", "\""}, {"#39", "'"}};
    std::string entity;
    for (char e = next(); e != ';'; e = next()) entity += e;
    REQUIRE(known.count(entity) == 1);
    return known.at(entity);
  }
  void attributes(Element &element)
  {
    while (std::isspace(peek())) {
      while (std::isspace(peek())) next();
      if (peek() == '/' || peek() == '>') return;
      const std::string key = name();
      expect("=\"");
      std::string value;
      while (peek() != '"') value += character();
      next();
      REQUIRE(element.attributes.emplace(key, value).second);
    }
  }
  void element()
  {
    Element read;
    expect("<");
    read.name = name();
    attributes(read);
    if (peek() == '/') {
      expect("/>");
    } else {
      expect(">");
      while (text_.compare(at_, 2, "</") != 0)
        if (peek() == '<') element();
        else read.text += character();
      expect("</" + read.name + ">");
    }
    elements.push_back(std::move(read));
  }

  const std::string &text_;
  size_t at_ = 0;
};

const char *const hostile = "a<b> & \"c\" 'd' ]]> </text>";

std::array<PlanColumn, 2> two_columns(size_t boxes)
{
  std::array<PlanColumn, 2> columns;
  for (size_t c = 0; c < 2; ++c) {
    columns[c] = {hostile, hostile, {{"solve", hostile, {}, {}}, {"events", "nothing", {}, {}}}};
    for (size_t k = 0; k < boxes; ++k) {
      const std::string name = "kernel_" + std::to_string(k);
      PlanStage &stage = columns[c].stages[0];
      (k % 4 ? stage.kernels : stage.buffers)
          .push_back({name, c || k % 2 ? "tbb" : hostile, hostile, c || k % 2, std::nullopt});
    }
  }
  return columns;
}

double number(const Element &element, const std::string &key) { return std::stod(element.attributes.at(key)); }

} // namespace

TEST_CASE("plan picture: well-formed whatever the names are, and each box once on either side")
{
  const std::string svg = svg_of(hostile, two_columns(40));
  const StrictXml xml(svg);
  CHECK(xml.elements.back().name == "svg");
  const auto told = [&](const std::string &text) {
    return std::count_if(xml.elements.begin(), xml.elements.end(),
                         [&](const Element &element) { return element.name == "text" && element.text == text; });
  };
  for (int k = 0; k < 40; ++k) CHECK(told("kernel_" + std::to_string(k)) == 2);
  CHECK(told("tbb") == 60);
  CHECK(told(hostile) ==
        1 + 2 + 2 + 2 + 20); /* the title; of each column title, summary and stage; of boxes left out */
}

TEST_CASE("plan picture: boxes lie on the sheet, apart, and at the same place in both columns")
{
  const StrictXml xml(svg_of("t", two_columns(60)));
  const Element &sheet = xml.elements.back();
  std::vector<const Element *> boxes;
  for (const Element &element : xml.elements)
    if (element.name == "rect" && element.attributes.count("x")) boxes.push_back(&element);
  REQUIRE(boxes.size() == 120);
  for (size_t i = 0; i < boxes.size(); ++i) {
    CHECK(number(*boxes[i], "x") >= 0);
    CHECK(number(*boxes[i], "x") + number(*boxes[i], "width") <= number(sheet, "width"));
    CHECK(number(*boxes[i], "y") + number(*boxes[i], "height") <= number(sheet, "height"));
    for (size_t j = 0; j < i; ++j) {
      const double x = number(*boxes[i], "x") - number(*boxes[j], "x");
      const bool beside = x >= number(*boxes[j], "width") || -x >= number(*boxes[i], "width");
      CHECK((beside || number(*boxes[i], "y") != number(*boxes[j], "y")));
    }
  }
  for (size_t i = 0; i < 60; ++i) {
    CHECK(number(*boxes[i], "y") == number(*boxes[i + 60], "y"));
    CHECK(number(*boxes[i], "width") == number(*boxes[i + 60], "width"));
    CHECK(std::abs(number(*boxes[i + 60], "x") - number(*boxes[i], "x") - 592) < 1e-6);
  }
}
#endif
