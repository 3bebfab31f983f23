#include "calls.h"

#include <bit>
#include <charconv>

namespace kolize::cli {
namespace {

// FNV-1a over words.
class Hash {
public:
    void add(std::uint64_t word) { value_ = (value_ ^ word) * 1099511628211ull; }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    template <class Vector>
    void add_all(const Vector& vector) {
        for (Eigen::Index i = 0; i < vector.size(); ++i) add(static_cast<double>(vector[i]));
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace

void apply(const BodyChange& change, World& world) {
    world.set_state(change.body, change.state);
    world.removed[change.body] = change.removed;
    world.asleep[change.body] = change.asleep;
}

std::uint64_t hash_of(std::span<const Contact> rows) {
    Hash hash;
    for (const Contact& row : rows) {
        for (const std::uint32_t id : {row.a, row.b, row.region}) hash.add(std::uint64_t(id));
        for (const Vec3& v : {row.normal, row.arm_a, row.arm_b}) hash.add_all(v);
        hash.add(row.depth);
    }
    return hash.value();
}

std::uint64_t hash_of(const World& world, std::span<const Contact> rows) {
    Hash hash;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const BodyState state = world.state(body);
        for (const Vec3& v : {state.position, state.velocity, state.angular_velocity}) hash.add_all(v);
        hash.add_all(state.orientation.coeffs());
        hash.add(std::uint64_t(world.asleep[body]));
    }
    for (const Contact& row : rows) {
        hash.add(row.impulse);
        hash.add_all(row.friction);
        hash.add_all(row.couple);
    }
    return hash.value();
}

std::string exact_text(double value) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::hex).ptr};
}

}  // namespace kolize::cli
