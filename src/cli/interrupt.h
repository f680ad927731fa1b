#pragma once

namespace morphbake::cli {

/// From now on the first Ctrl-C (SIGINT) or SIGTERM only asks to stop; the second ends the program
/// at once.
void catch_interrupts();

/// Whether somebody has asked to stop.
bool is_interrupted();

}  // namespace morphbake::cli
