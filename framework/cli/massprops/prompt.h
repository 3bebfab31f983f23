// Asking for what was not given on the command line.
#pragma once

#include "massprops/options.h"

#include <istream>
#include <ostream>

namespace kolize::cli {

// Asks for file, step and number of axes in turn; an empty answer takes the value that is shown. What cannot be read is
// asked for again. Throws Error when the input ends.
void ask_for(MassPropsOptions& options, std::istream& in, std::ostream& out);

}  // namespace kolize::cli
