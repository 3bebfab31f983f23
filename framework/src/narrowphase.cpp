#include <kolize/narrowphase.h>

#include <algorithm>
#include <stdexcept>

namespace kolize {

void Narrowphase::find_impacts(const ImpactInput&, std::span<double>) {
    throw std::logic_error("it does not find times of impact");
}

void Narrowphase::find_touching(const NarrowphaseInput&, Contacts&) {
    throw std::logic_error("it does not find touching points");
}

void Narrowphase::find_crossings(const NarrowphaseInput&, std::vector<CrossingLine>&) {}

double touch_distance(const World& world, std::uint32_t a, std::uint32_t b) {
    constexpr double of_size = 2e-14, of_rounding = 4 * std::numeric_limits<double>::epsilon();
    double size = 0, offset = 0;
    for (const std::uint32_t body : {a, b}) {
        const Shape& shape = world.shape_of(body);
        if (shape.kind != ShapeKind::half_space) size += shape.radius;
        offset = std::max(offset, world.position[body].cwiseAbs().maxCoeff());
    }
    return of_size * size + of_rounding * offset;
}

}  // namespace kolize
