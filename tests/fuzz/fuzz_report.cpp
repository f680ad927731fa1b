// Fuzz target: a batch's report. What is read of a line is written, and must read as the same.

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "fuzz/fuzz_folder.h"
#include "morphbake/batch/batch_page.h"
#include "morphbake/batch/report_file.h"

// NOLINTNEXTLINE: libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace morphbake;
  static const fuzz::FuzzFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const ReportIndex index({folder.write("report.jsonl", text)});
  for (const std::string& name : index.names()) {
    for (const ReportLine& line : index.lines_of(name)) {
      const std::optional<BatchRecord> record = record_from_line(line.text);
      if (!record) continue;
      std::ostringstream page;
      write_page_row(page, *record);
      const std::string written = record_to_line(*record);
      const std::optional<BatchRecord> again = record_from_line(written);
      if (!again || record_to_line(*again) != written) std::abort();
      if (start_of_line(written).name != record->name) std::abort();
    }
  }
  return 0;
}
