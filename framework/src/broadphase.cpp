#include <kolize/broadphase.h>

#include <sstream>
#include <stdexcept>

namespace kolize {

void Broadphase::choose_from(std::shared_ptr<const BroadphaseChoice>) {}

void Broadphase::outline(const BroadphaseInput&, Outline&) {}

namespace {

// Written so that a NaN fails, and without branches: this runs over every box of every step.
bool is_valid(const Aabb& box) {
    constexpr double largest = std::numeric_limits<double>::max();
    bool valid = true;
    for (int axis = 0; axis < 3; ++axis)
        valid &= (box.min[axis] <= box.max[axis]) & (box.min[axis] >= -largest) & (box.max[axis] <= largest);
    return valid;
}

[[noreturn]] void refuse(std::size_t row, const Aabb& box) {
    const Eigen::IOFormat list(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", ", ", "", "", "(", ")");
    std::ostringstream text;
    text << "the box of row " << row << (box.finite() ? " is inverted" : " is not finite") << ": min "
         << box.min.format(list) << ", max " << box.max.format(list);
    throw std::invalid_argument(text.str());
}

}  // namespace

void require_valid_bounds(std::span<const Aabb> bounds) {
    for (std::size_t row = 0; row < bounds.size(); ++row)
        if (!is_valid(bounds[row])) refuse(row, bounds[row]);
}

}  // namespace kolize
