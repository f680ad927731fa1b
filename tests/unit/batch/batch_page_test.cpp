#include "morphbake/batch/batch_page.h"

#include <gmock/gmock.h>

#include <sstream>

namespace morphbake {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string row_of(const BatchRecord& record) {
  std::ostringstream page;
  write_page_row(page, record);
  return page.str();
}

TEST(BatchPage, EscapesEverything) {
  BatchRecord record;
  record.name = "<b>&\"'\n";
  record.problems = {
      {Severity::Error, "a.b", {"<file>", ""}, "<script>alert(1)</script>", "\"h\""}};
  record.log = "</pre>\n\x1b[31m<img src=x>";
  record.outputs = {{record.name + "/a b%#?.sheet.png", true, 1, 1, "h"},
                    {record.name + "/\xc3\xa4.glb", true, 1, 1, "h"}};
  const std::string row = row_of(record);
  EXPECT_THAT(row, HasSubstr("<b>&lt;b&gt;&amp;&quot;&#39;\\u000a</b>"));
  EXPECT_THAT(row, HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_THAT(row, Not(HasSubstr("<script>")));
  EXPECT_THAT(row, HasSubstr("<pre>&lt;/pre&gt;\n\\u001b[31m&lt;img src=x&gt;</pre>"));
  EXPECT_THAT(row, HasSubstr("src=\"./%3Cb%3E%26%22%27%0A/a%20b%25%23%3F.sheet.png\""));
  EXPECT_THAT(row, HasSubstr("/%C3%A4.glb\""));
}

TEST(BatchPage, AsksForNothingFromElsewhere) {
  std::ostringstream page;
  write_page_start(page, {});
  write_page_end(page);
  for (const char* outside : {"http:", "https:", "//cdn", "src=", "@import", "<link"}) {
    EXPECT_THAT(page.str(), Not(HasSubstr(outside))) << outside;
  }
}

}  // namespace
}  // namespace morphbake
