/* Text from anywhere becomes valid XML. */
#include "tests/catch.h"
#include "tools/plot/markup.h"

using namespace tandem;

TEST_CASE("escaped text holds no markup, no control characters and only UTF-8")
{
  CHECK(escaped("a < b & \"c\" > 'd'") == "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  CHECK(escaped("Gr\u00f6\u00dfe \u221e \U0001f600\t\n") == "Gr\u00f6\u00dfe \u221e \U0001f600\t\n");
  const std::string bad = "\xef\xbf\xbd";
  CHECK(escaped(std::string("a\0b\x01\x1b\x7f", 6)) == "a" + bad + "b" + bad + bad + bad);
  CHECK(escaped("\xff<\xc3") == bad + "&lt;" + bad);
  CHECK(escaped("\xe2\x88") == bad + bad);
}
