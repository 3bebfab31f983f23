// Models of several closed parts: which of them are inside out.
#pragma once

#include <kolize/mesh.h>

namespace kolize::cli {

struct PartsReport {
    std::size_t parts = 0;   // connected by common vertices
    std::size_t turned = 0;  // faced inward though they bound no cavity
    std::size_t nested =
        0;  // lie, in whole or in the most part, within others without being a cavity: they count twice
};

// Looks at every part from just outside and just inside. On the outer side of a part that is as it should be, the
// surface winds 0 times around a point, also in a cavity; -1 means that the part is inside out: it is turned. Wants a
// surface that bounds a volume.
PartsReport orient_parts(TriangleSoup& surface);

}  // namespace kolize::cli
