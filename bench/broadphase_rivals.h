// The broadphases of other libraries behind one interface.
#pragma once

#include "moving_boxes.h"

#include <kolize/broadphase.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bench {

class Contestant {
public:
    virtual ~Contestant() = default;
    // Puts the complete list of overlapping pairs of this frame into `pairs`, in any order.
    virtual void find_pairs(const Frame& frame, std::vector<kolize::Pair>& pairs) = 0;

    std::string name;
};

// Bullet, FCL, CGAL and Embree, each with its boxes as they are in `first`. Made one by one, because some are large:
// only those whose name `wanted` takes.
std::vector<std::unique_ptr<Contestant>> rival_broadphases(const Frame& first,
                                                           const std::function<bool(const std::string&)>& wanted);

}  // namespace bench
