#pragma once

#include <ostream>

#include "morphbake/batch/batch_record.h"
#include "morphbake/batch/run_batch.h"

namespace morphbake {

/// Writes a page of a library piece by piece: what stands before its rows, with how many there are.
///
/// The page is one file that asks for nothing but the contact sheets beside it. A click on the head
/// of a column sorts by it.
void write_page_start(std::ostream& page, const BatchProgress& progress);

/// Writes what came of a recipe.
void write_page_row(std::ostream& page, const BatchRecord& record);

void write_page_end(std::ostream& page);

}  // namespace morphbake
