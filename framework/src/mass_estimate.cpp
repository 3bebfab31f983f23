// Mass properties from samples of the winding number, and how far they can be trusted.
#include <kolize/winding_number.h>

#include <algorithm>
#include <numeric>

namespace kolize {

namespace {

// Equal cells that fill the bounding box, in an order in which each one is the neighbour of the one before. The point
// of a cell is anywhere in it, with equal chances: midpoints would all fall on the same side of a wall along the axes.
class Grid {
public:
    // Cells as close to cubes as whole numbers of them allow. The samples are shared out to the axes, the shortest
    // first, so that a thin box is cut into cells of its own thickness.
    Grid(const Aabb& box, std::size_t samples) : origin_(box.min) {
        const Vec3 size = box.max - box.min, sides = size / size.maxCoeff();
        std::array<int, 3> axes = {0, 1, 2};
        std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] < size[b]; });
        double left = std::max(1.0, static_cast<double>(samples)), room = sides.prod();
        for (int k = 0; k < 3; ++k) {
            const double side = sides[axes[k]], cell = std::pow(room / left, 1.0 / (3 - k));
            const double number = std::max(1.0, std::min(std::round(side / cell), std::floor(left)));
            cells_[axes[k]] = static_cast<std::size_t>(number);
            cell_[axes[k]] = size[axes[k]] / number;
            left /= number;
            room /= side;
        }
    }

    std::size_t size() const { return cells_[0] * cells_[1] * cells_[2]; }
    double cell_volume() const { return cell_.prod(); }
    const Vec3& origin() const { return origin_; }
    Vec3 extents() const { return cell_.cwiseProduct(Vec3(cells_[0], cells_[1], cells_[2])); }

    // The point of a cell, seen from the origin of the grid.
    Vec3 point(std::size_t index) const {
        const std::size_t row = index / cells_[0], layer = row / cells_[1];
        const std::size_t i = index % cells_[0], j = row % cells_[1];
        const Vec3 corner(row % 2 ? cells_[0] - 1 - i : i, layer % 2 ? cells_[1] - 1 - j : j, layer);
        return cell_.cwiseProduct(corner + Vec3(random(3 * index), random(3 * index + 1), random(3 * index + 2)));
    }

private:
    // From 0 to 1, by number: the output function of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom
    // number generators", OOPSLA 2014).
    static double random(std::uint64_t number) {
        std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
    }

    Vec3 origin_;
    Vec3 cell_;
    std::array<std::size_t, 3> cells_;
};

// Running sums over the points that are inside.
struct Sums {
    std::size_t count = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();

    void add(const Vec3& p) {
        ++count;
        first += p;
        second += p * p.transpose();
    }
};

Mat3 inertia_of(const Mat3& covariance) { return covariance.trace() * Mat3::Identity() - covariance; }

// Points are seen from the origin of the grid, and so is the centre.
MassProperties properties(const Sums& sums, const Grid& grid) {
    MassProperties result;
    if (sums.count == 0) return result;
    const auto count = static_cast<double>(sums.count);
    result.volume = count * grid.cell_volume();
    result.center_of_mass = sums.first / count;
    const Mat3 covariance = sums.second / count - result.center_of_mass * result.center_of_mass.transpose();
    result.inertia_over_mass = inertia_of(covariance);
    return result;
}

// By how much one sample changes the results, to first order, if it counts as inside.
struct Influence {
    double volume = 0;
    Vec3 center = Vec3::Zero();
    Mat3 inertia = Mat3::Zero();
};

Influence influence_of(const Vec3& point, const MassProperties& mass, const Grid& grid) {
    Influence result{grid.cell_volume()};
    if (mass.volume == 0) return result;
    const double share = grid.cell_volume() / mass.volume;
    const Vec3 arm = point - mass.center_of_mass;
    result.center = share * arm;
    result.inertia = share * (inertia_of(arm * arm.transpose()) - mass.inertia_over_mass);
    return result;
}

// Standard errors from successive differences. Each sample stands for a cell of its own, so the variance of a total is
// the sum of the variances of its terms f. Half the squared difference of two terms has the expectation
// (var f1 + var f2 + (mean f1 - mean f2)^2) / 2; summed over each sample and the next one, all around, it is the
// variance or more. (Collapsed strata: Cochran, Sampling Techniques, 5A.12; Wolter, Introduction to Variance
// Estimation, ch. 8.)
class SamplingError {
public:
    // Samples that all agree do not prove that no part of a cell is different. Counting one sample at the farthest
    // corner as wrong makes three cells of it: the rule of three for what was never found.
    explicit SamplingError(const Influence& farthest) { add(farthest, 1); }

    void add_difference(const Influence& a, const Influence& b) {
        add({a.volume - b.volume, a.center - b.center, a.inertia - b.inertia}, 0.5);
    }

    Influence three_standard_errors() const {
        return {3 * std::sqrt(variance_.volume), 3 * variance_.center.cwiseSqrt(), 3 * variance_.inertia.cwiseSqrt()};
    }

private:
    void add(const Influence& f, double factor) {
        variance_.volume += factor * f.volume * f.volume;
        variance_.center += factor * f.center.cwiseAbs2();
        variance_.inertia += factor * f.inertia.cwiseAbs2();
    }

    Influence variance_;
};

// The winding number at each point of the grid. What faces inward is turned: the sum of all is never negative.
std::vector<double> sample(const TriangleSoup& surface, const Grid& grid, Host& host,
                           const std::function<void(std::size_t, std::size_t)>& advance) {
    const WindingNumber winding(surface);
    std::vector<double> numbers(grid.size());
    host.parallel_for(grid.size(), 1024, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) numbers[i] = winding.at(grid.origin() + grid.point(i));
        if (advance) advance(end - begin, grid.size());
    });
    if (std::accumulate(numbers.begin(), numbers.end(), 0.0) < 0)
        for (double& number : numbers) number = -number;
    return numbers;
}

MassProperties properties_above(double limit, const std::vector<double>& numbers, const Grid& grid) {
    Sums sums;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] > limit) sums.add(grid.point(i));
    return properties(sums, grid);
}

// Makes the range wide enough for what the mass properties would be with another limit between inside and outside.
void widen(MassEstimate& range, const MassProperties& other) {
    range.volume = std::max(range.volume, std::abs(other.volume - range.mass.volume));
    if (other.volume == 0 || range.mass.volume == 0) return;
    range.center_of_mass = range.center_of_mass.cwiseMax((other.center_of_mass - range.mass.center_of_mass).cwiseAbs());
    range.inertia_over_mass =
        range.inertia_over_mass.cwiseMax((other.inertia_over_mass - range.mass.inertia_over_mass).cwiseAbs());
}

Influence sampling_error(const std::vector<double>& numbers, const MassProperties& mass, const Grid& grid) {
    const Vec3 extents = grid.extents();
    const Vec3 farthest = (mass.center_of_mass.array() > 0.5 * extents.array()).select(Vec3::Zero(), extents);
    SamplingError error(influence_of(farthest, mass, grid));
    const auto term = [&](std::size_t i) {
        return numbers[i] > 0.5 ? influence_of(grid.point(i), mass, grid) : Influence{};
    };
    Influence previous = term(numbers.size() - 1);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const Influence next = term(i);
        error.add_difference(previous, next);
        previous = next;
    }
    return error.three_standard_errors();
}

}  // namespace

MassEstimate estimate_mass_properties(const TriangleSoup& surface, std::size_t samples, Host& host,
                                      const std::function<void(std::size_t, std::size_t)>& advance) {
    Aabb box;
    for (const Triangle& triangle : surface.triangles)
        for (const std::uint32_t v : triangle) box.include(surface.vertices[v]);
    MassEstimate result;
    if (surface.triangles.empty() || (box.max - box.min).minCoeff() <= 0) return result;  // nothing can be inside
    const Grid grid(box, samples);
    const std::vector<double> numbers = sample(surface, grid, host, advance);
    result.samples = grid.size();
    result.mass = properties_above(0.5, numbers, grid);
    for (const double limit : {0.25, 0.75}) widen(result, properties_above(limit, numbers, grid));
    const Influence error = sampling_error(numbers, result.mass, grid);
    result.volume += error.volume;
    result.center_of_mass += error.center;
    result.inertia_over_mass += error.inertia;
    if (result.mass.volume > 0) result.mass.center_of_mass += grid.origin();
    return result;
}

}  // namespace kolize
