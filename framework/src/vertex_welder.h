// Makes one vertex of all that are equal, coordinate by coordinate.
#pragma once

#include <kolize/math.h>

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace kolize {

// Appends the first of every set of equal points to a vector of vertices, in the order in which they come.
class VertexWelder {
public:
    // `vertices` belongs to the caller, starts empty and outlives the welder.
    explicit VertexWelder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

    std::uint32_t index_of(const Vec3& p) {
        const Vec3 key = p + Vec3::Zero();  // -0 becomes 0
        const auto [found, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) vertices_.push_back(key);
        return found->second;
    }

private:
    struct Hash {
        std::size_t operator()(const Vec3& p) const {
            std::uint64_t h = 0;
            for (const double x : p) {
                h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
                h ^= h >> 32;
            }
            return h;
        }
    };

    std::vector<Vec3>& vertices_;
    std::unordered_map<Vec3, std::uint32_t, Hash> index_;
};

}  // namespace kolize
