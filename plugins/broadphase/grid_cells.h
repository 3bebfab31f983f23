// The cells of the broadphase grid: boxes by the cell of their min corner, level by level of sizes.
//
// A cell is 4096 units wide. Boxes lie in the order of their cells as 16-bit units, which wrap round: between
// neighbouring cells differences are right all the same, and one instruction makes all six of them. Going from metres
// to units is monotone, so boxes that are apart in units are apart, boxes that overlap by a unit overlap, and only
// those that touch in units are compared in metres. For the same reason boxes that are too far away to be counted can
// all go into the outermost cells. The array of cells is not much longer than there are boxes, however far apart they
// are: what lies beyond the end of a row goes on in the next one, and beyond the last row in the first. Such levels are
// `folded`. That adds candidates from far away, so there all are compared in metres.
#pragma once

#include <kolize/plugin.h>

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace kolize {

inline constexpr int cell_bits = 12;
inline constexpr std::int64_t cell_units = 1 << cell_bits;
inline constexpr std::uint32_t none = ~0u;

using Cell = std::array<std::int64_t, 3>;

// In units of a level.
struct UnitBox {
    std::int64_t min[3], max[3];

    UnitBox coarser(int bits) const {
        UnitBox box = *this;
        for (int axis = 0; axis < 3; ++axis) box.min[axis] >>= bits, box.max[axis] >>= bits;
        return box;
    }
    Cell cell() const { return {min[0] >> cell_bits, min[1] >> cell_bits, min[2] >> cell_bits}; }
    std::int64_t length() const { return std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]}); }
};

// Of a box, modulo 2^16 units: an instruction subtracts it from another's max and -min.
struct alignas(16) Item {
    std::int16_t min[3], minus_max[3];
    std::uint32_t row;  // none: it has gone

    Item() = default;
    Item(const UnitBox& box, std::uint32_t r) : row(r) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = static_cast<std::int16_t>(box.min[axis]);
            minus_max[axis] = static_cast<std::int16_t>(-box.max[axis]);
        }
    }
    std::int32_t in_cell(int axis) const { return min[axis] & (cell_units - 1); }
    std::int32_t length(int axis) const { return static_cast<std::uint16_t>(-minus_max[axis] - min[axis]); }
    __m128i load() const { return _mm_load_si128(reinterpret_cast<const __m128i*>(this)); }
    __m128i probe() const {
        return _mm_setr_epi16(static_cast<short>(-minus_max[0]), static_cast<short>(-minus_max[1]),
                              static_cast<short>(-minus_max[2]), static_cast<short>(-min[0]),
                              static_cast<short>(-min[1]), static_cast<short>(-min[2]), 0, 0);
    }
};

// A set of rows, in bits: what is asked for at random should lie in the nearest cache.
class RowSet {
public:
    void resize_empty(std::size_t rows) { words_.assign((rows + 63) / 64, 0); }
    void add(std::uint32_t row) { words_[row / 64] |= bit(row); }
    void remove(std::uint32_t row) { words_[row / 64] &= ~bit(row); }
    bool has(std::uint32_t row) const { return words_[row / 64] >> row % 64 & 1; }

private:
    static std::uint64_t bit(std::uint32_t row) { return std::uint64_t(1) << row % 64; }
    std::vector<std::uint64_t> words_;
};

// Pairs on their way to whoever asked: finding them and judging them take turns, so that neither has to guess what the
// other will do.
struct Found {
    struct Candidate {
        std::uint32_t a, b;
        bool certain;
    };
    static constexpr std::uint32_t capacity = 256;
    std::uint32_t count = 0;
    Candidate candidates[capacity + 1];

    template <class Hit>
    void empty_into(Hit&& hit) {
        for (std::uint32_t i = 0; i < count; ++i)
            if (candidates[i].b != none) hit(candidates[i].a, candidates[i].b, candidates[i].certain);
        count = 0;
    }
};

// The cells of a level are numbered x + row y + layer z from its first one, modulo their number.
struct Level {
    double longest = 0;      // size, see Cells::size_of
    int bits = 0;            // its units are 2^bits of the finest ones
    std::int64_t reach = 0;  // units: no box filed here is longer
    std::uint32_t boxes = 0;
    Cell first{}, last{};  // with an empty one on either side
    std::uint32_t first_slot = 0, slots = 0, row = 0, layer = 0;
    bool folded = false;

    bool holds(const Cell& cell) const {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) inside &= (first[axis] <= cell[axis]) & (cell[axis] <= last[axis]);
        return inside;
    }
    std::uint32_t slot(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const auto sum = static_cast<std::uint64_t>((x - first[0]) + (y - first[1]) * row + (z - first[2]) * layer);
        return static_cast<std::uint32_t>(sum < slots ? sum : sum % slots);
    }
    std::uint32_t slot(const Cell& cell) const { return slot(cell[0], cell[1], cell[2]); }
};

inline bool is_valid(const Aabb& box) {
    constexpr double largest = std::numeric_limits<double>::max();
    bool valid = true;
    for (int axis = 0; axis < 3; ++axis)
        valid &= (box.min[axis] <= box.max[axis]) & (box.min[axis] >= -largest) & (box.max[axis] <= largest);
    return valid;
}

// Boxes in the cells of all levels, the coarsest first.
class Cells {
public:
    // After this, building so many boxes allocates nothing, wherever they are.
    void reserve(std::size_t boxes) {
        levels_.reserve(max_levels);
        slots_.reserve(2 * slots_per_box * boxes + 125 * max_levels);
        unsorted_.reserve(boxes);
        items_.reserve(boxes + 3);
        where_.reserve(boxes);
        slot_.reserve(boxes);
    }

    // Throws for bad boxes.
    void build(std::span<const Aabb> bounds, std::span<const std::uint32_t> rows, double cell_size) {
        crowded_ = crowded_ || cell_size > 0;  // cells are as large as they were asked to be
        choose_origin(bounds, rows, cell_size);
        count_sizes(bounds, rows);
        do {
            choose_levels();
            count_boxes(bounds, rows);
        } while (is_crowded());
        sort();
    }

    // Forgets that boxes were found crowded in large cells.
    void forget() { crowded_ = false; }

    // The i-th box of build() has moved. False if it is not in its cell any more; it is then taken out.
    bool move(std::uint32_t i, const Aabb& box) {
        const std::size_t index = level_of(box);
        Level& level = levels_[index];
        const UnitBox in_level = units(box).coarser(level.bits);
        const Cell cell = in_level.cell();
        Item& item = items_[where_[i]];
        if (size_of(box) > level.longest || !level.holds(cell) || level.first_slot + level.slot(cell) != slot_[i]) {
            item.row = none;
            return false;
        }
        item = Item(in_level, item.row);
        level.reach = std::max(level.reach, in_level.length());
        return true;
    }

    // What move() will ask for.
    void prefetch(std::uint32_t i) const { __builtin_prefetch(&items_[where_[i]]); }

    // Calls visit(row) in the order of the cells.
    template <class Visit>
    void for_each(Visit&& visit) const {
        for (std::size_t i = 0; i < where_.size(); ++i)
            if (items_[i].row != none) visit(items_[i].row);
    }

    // Calls hit(a, b, certain) for every two boxes that may overlap, once; they do if it is certain.
    template <class Hit>
    void for_all(std::span<const Aabb> bounds, Hit&& hit) const {
        Found found;
        for (const Level& level : levels_)
            for (std::uint32_t slot = 0; slot < level.slots; ++slot) {
                const std::uint32_t* const slots = slots_.data() + level.first_slot + slot;
                for (std::uint32_t i = slots[0]; i < slots[1]; ++i) look_onwards(level, slot, i, found, hit);
            }
        for (std::size_t own = 1; own < levels_.size(); ++own)
            for (std::uint32_t i = slots_[levels_[own].first_slot]; i < end_of(levels_[own]); ++i) {
                const std::uint32_t row = items_[i].row;
                const UnitBox box = units(bounds[row]);
                for (std::size_t coarse = 0; coarse < own; ++coarse) look_around(levels_[coarse], row, box, found, hit);
            }
        found.empty_into(hit);
    }

    // For every box of the set, in the order of the cells, calls hit(row, b, certain) for all others here that may
    // overlap it. build() was given all rows in their order.
    template <class Hit>
    void for_rows(const RowSet& rows, std::span<const Aabb> bounds, Found& found, Hit&& hit) const {
        std::array<Surroundings, 16> some;
        for (const Level& level : levels_) {
            std::size_t count = 0;
            for (std::uint32_t i = slots_[level.first_slot]; i < end_of(level); ++i) {
                const std::uint32_t row = items_[i].row;
                if (row == none || !rows.has(row)) continue;
                some[count++].item = i;
                __builtin_prefetch(&slot_[row]);
                if (count == some.size()) look_about(level, {some.data(), std::exchange(count, 0)}, found, hit);
                if (levels_.size() > 1) look_elsewhere(level, row, bounds[row], found, hit);
            }
            look_about(level, {some.data(), count}, found, hit);
        }
    }

    // Calls hit(row, b, certain) for every box b that may overlap this one, perhaps itself.
    template <class Hit>
    void for_box(std::uint32_t row, const Aabb& box, Found& found, Hit&& hit) const {
        const UnitBox finest = units(box);
        const double size = size_of(box);
        for (const Level& level : levels_)
            if (size <= level.longest)
                look_around(level, row, finest, found, hit);
            else
                look_inside(level, row, finest, hit);
    }

    // About how many cells for_box looks at in finer levels.
    double cells_inside(const Aabb& box) const {
        if (levels_.size() == 1) return 0;
        const UnitBox finest = units(box);
        const double size = size_of(box);
        double sum = 0;
        for (const Level& level : levels_)
            if (size > level.longest) {
                const auto [first, last] = range(level, finest.coarser(level.bits));
                sum += level.folded ? level.boxes
                                    : static_cast<double>((last[1] - first[1] + 1) * (last[2] - first[2] + 1));
            }
        return sum;
    }

    // The cells in use.
    void outline(std::span<const Aabb> bounds, Outline& outline) const {
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            std::vector<Cell> cells;
            for (std::uint32_t k = slots_[levels_[i].first_slot]; k < end_of(levels_[i]); ++k)
                cells.push_back(units(bounds[items_[k].row]).coarser(levels_[i].bits).cell());
            std::sort(cells.begin(), cells.end());
            cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
            const double side = std::ldexp(cell_units / units_per_size_, levels_[i].bits) / shrunk;
            for (const Cell& cell : cells) {
                const Vec3 corner = origin_ + side * Vec3(double(cell[0]), double(cell[1]), double(cell[2]));
                outline.boxes.push_back({{corner, corner + Vec3::Constant(side)}, static_cast<std::uint32_t>(i)});
            }
        }
    }

private:
    static constexpr std::size_t max_levels = 16;
    static constexpr double level_ratio = 4;      // of sizes that share a level, and up to twice that
    static constexpr double boxes_in_a_cell = 2;  // where there is a choice
    static constexpr double crowd = 8;            // boxes that a box finds in its cell, on average
    static constexpr std::uint32_t slots_per_box = 4;
    static constexpr double shrunk = 0x1p-4;    // sizes are this part of the longest side, or they overflow
    static constexpr double farthest = 0x1p42;  // units from the origin
    static constexpr double roomiest = 0x1p28;  // cells in which the middle half of the boxes may lie

    // Sizes are counted by their binary exponent.
    struct SizeClass {
        double longest = 0;
        std::uint32_t count = 0;
        std::uint32_t level = 0;
    };

    double size_of(const Aabb& box) const {
        const Vec3 sides = shrunk * box.max - shrunk * box.min;
        return std::max({sides.x(), sides.y(), sides.z(), least_size_});
    }
    static std::size_t class_index(double size) { return std::bit_cast<std::uint64_t>(size) >> 52 & 2047; }
    std::size_t level_of(const Aabb& box) const { return classes_[class_index(size_of(box))].level; }
    std::uint32_t end_of(const Level& level) const { return slots_[level.first_slot + level.slots]; }

    // In the middle of the boxes, wherever a few of them have gone. Cells must not be too small for it to reach the
    // others: boxes may be points.
    void choose_origin(std::span<const Aabb> bounds, std::span<const std::uint32_t> rows, double cell_size) {
        constexpr std::size_t samples = 64;
        double spread = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<double, samples> sample;
            for (std::size_t i = 0; i < samples; ++i) {
                const double x = bounds[rows[i * rows.size() / samples]].min[axis];
                sample[i] = std::isfinite(x) ? x : 0;  // refused later
            }
            std::sort(sample.begin(), sample.end());
            origin_[axis] = sample[samples / 2];
            spread = std::max(spread, shrunk * sample[3 * samples / 4] - shrunk * sample[samples / 4]);
        }
        least_size_ = std::max({spread / roomiest, 0.5 * shrunk * cell_size, 1e-300});
    }

    void count_sizes(std::span<const Aabb> bounds, std::span<const std::uint32_t> rows) {
        for (std::size_t i = first_class_; i <= last_class_; ++i) classes_[i] = {};
        first_class_ = classes_.size() - 1;
        last_class_ = 0;
        corners_ = {};
        bool valid = true;
        for (const std::uint32_t row : rows) {
            valid &= is_valid(bounds[row]);
            const double size = size_of(bounds[row]);
            const std::size_t index = class_index(size);
            first_class_ = std::min(first_class_, index);
            last_class_ = std::max(last_class_, index);
            SizeClass& c = classes_[index];
            c.longest = std::max(c.longest, size);
            ++c.count;
            corners_.include(bounds[row].min);
        }
        if (!valid) require_valid_bounds(bounds);
    }

    void choose_levels() {
        levels_.clear();
        std::uint32_t left = 0;
        for (std::size_t i = first_class_; i <= last_class_; ++i) left += classes_[i].count;
        for (std::size_t i = last_class_ + 1; i-- > first_class_;) {
            SizeClass& c = classes_[i];
            if (c.count > 0 && (levels_.empty() || needs_level(c, left))) levels_.push_back({.longest = c.longest});
            c.level = levels_.empty() ? 0 : static_cast<std::uint32_t>(levels_.size() - 1);
            if (c.count > 0) levels_.back().boxes += c.count;
            left -= c.count;
        }
        double finest = infinity;
        for (const Level& level : levels_) finest = std::min(finest, cell_for(level));
        units_per_size_ = cell_units / finest;
        for (Level& level : levels_)
            while (level.bits < 44 && std::ldexp(finest, level.bits) < cell_for(level)) ++level.bits;
    }

    // Whether the boxes left, of this size and below, would crowd the cells of the level above.
    bool needs_level(const SizeClass& c, double left) const {
        const Level& above = levels_.back();
        if (c.longest * level_ratio >= above.longest || levels_.size() == max_levels) return false;
        return crowded_ || left > boxes_in_a_cell * room(2 * above.longest);
    }

    // How many cells of this side all boxes take.
    double room(double side) const {
        const Vec3 extent = shrunk * corners_.max - shrunk * corners_.min;
        return (extent / side).cwiseMax(1).prod();
    }

    double cell_for(const Level& level) const {
        const double least = 2 * (1 + 0x1p-8) * level.longest;
        if (crowded_) return least;
        return least * std::max(1.0, std::cbrt(boxes_in_a_cell * room(least) / level.boxes));
    }

    // As many slots as there are cells, but no more than a few for each box: the shortest axis is served first.
    void choose_slots(Level& level) const {
        const UnitBox box = units(corners_).coarser(level.bits);
        std::array<std::int64_t, 3> size;
        for (int axis = 0; axis < 3; ++axis) {
            level.first[axis] = (box.min[axis] >> cell_bits) - 1;
            level.last[axis] = (box.max[axis] >> cell_bits) + 1;
            size[axis] = level.last[axis] - level.first[axis] + 1;
        }
        std::array<int, 3> axes{0, 1, 2};
        std::sort(axes.begin(), axes.end(), [&](int i, int j) { return size[i] < size[j]; });
        double left = 27 + slots_per_box * static_cast<double>(level.boxes);
        level.folded = false;
        for (int i = 0; i < 3; ++i) {
            const auto fair = std::max(3.0, std::floor(std::pow(left, 1.0 / (3 - i))));
            std::int64_t& cells = size[axes[i]];
            level.folded |= static_cast<double>(cells) > fair;
            cells = static_cast<std::int64_t>(std::min(static_cast<double>(cells), fair));
            left /= static_cast<double>(cells);
        }
        level.row = static_cast<std::uint32_t>(size[0]);
        level.layer = static_cast<std::uint32_t>(size[0] * size[1]);
        level.slots = static_cast<std::uint32_t>(size[0] * size[1] * size[2]);
    }

    // Of the finest level. Monotone in every coordinate, which is all that finding every pair rests on.
    UnitBox units(const Aabb& box) const {
        UnitBox result;
        for (int axis = 0; axis < 3; ++axis) {
            result.min[axis] = unit(box.min[axis], axis);
            result.max[axis] = unit(box.max[axis], axis);
        }
        return result;
    }
    std::int64_t unit(double x, int axis) const {
        constexpr double to_integer = 0x1.8p52;  // a sum with it has whole units in its last bits
        const double exact = (shrunk * x - shrunk * origin_[axis]) * units_per_size_ - 0.5;
        const double rounded = std::min(std::max(exact, -farthest), farthest) + to_integer;
        return std::bit_cast<std::int64_t>(rounded) - std::bit_cast<std::int64_t>(to_integer);
    }

    void count_boxes(std::span<const Aabb> bounds, std::span<const std::uint32_t> rows) {
        std::uint32_t slots = 0;
        for (Level& level : levels_) {
            choose_slots(level);
            level.first_slot = std::exchange(slots, slots + level.slots);
        }
        slots_.assign(slots + 1, 0);
        unsorted_.resize(rows.size());
        slot_.resize(rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const Aabb& box = bounds[rows[i]];
            Level& level = levels_[level_of(box)];
            const UnitBox in_level = units(box).coarser(level.bits);
            level.reach = std::max(level.reach, in_level.length());
            unsorted_[i] = Item(in_level, rows[i]);
            slot_[i] = level.first_slot + level.slot(in_level.cell());
            ++slots_[slot_[i]];
        }
    }

    // Then larger cells were not a good idea.
    bool is_crowded() {
        if (crowded_) return false;
        double sum = 0;
        for (const double boxes : slots_) sum += boxes * boxes;
        crowded_ = sum > crowd * static_cast<double>(unsorted_.size());
        return crowded_;
    }

    // Counting sort: afterwards the items of a slot are those from slots_[slot] up to slots_[slot + 1].
    void sort() {
        std::uint32_t end = 0;
        for (std::uint32_t& slot : slots_) slot = end += slot;
        items_.resize(unsorted_.size() + 3);  // tested by fours
        where_.resize(unsorted_.size());
        for (std::size_t i = unsorted_.size(); i-- > 0;) {
            where_[i] = --slots_[slot_[i]];
            items_[where_[i]] = unsorted_[i];
        }
    }

    // Those after an item in its own cell, and in the cells after it that it reaches.
    template <class Hit>
    void look_onwards(const Level& level, std::uint32_t slot, std::uint32_t i, Found& found, Hit&& hit) const {
        const Item& item = items_[i];
        const __m128i probe = item.probe();
        std::uint32_t low[3], high[3];  // cells below it and above it
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = item.in_cell(axis) < level.reach;
            high[axis] = static_cast<std::uint32_t>(item.in_cell(axis) + item.length(axis)) >> cell_bits;
        }
        test(level, item.row, probe, i + 1, slots_[level.first_slot + slot + 1], found, hit);
        if (high[0] > 0) test_slots(level, item.row, probe, slot + 1, 1, found, hit);
        std::uint32_t rows[4], count = 0;
        rows[count] = slot + level.row, count += high[1];
        rows[count] = slot + level.layer - level.row, count += high[2] & low[1];
        rows[count] = slot + level.layer, count += high[2];
        rows[count] = slot + level.layer + level.row, count += high[2] & high[1];
        for (std::uint32_t k = 0; k < count; ++k)
            test_slots(level, item.row, probe, rows[k] - low[0], 1 + low[0] + high[0], found, hit);
    }

    // An item and the slots that it may reach: so many in a row from each of `first` on.
    struct Surroundings {
        std::uint32_t item, count, rows;
        std::uint32_t first[9];
    };

    void find_surroundings(const Level& level, Surroundings& s) const {
        const Item& item = items_[s.item];
        std::int64_t low[3], high[3];  // cells below it and above it
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = item.in_cell(axis) < level.reach;
            high[axis] = static_cast<std::uint32_t>(item.in_cell(axis) + item.length(axis)) >> cell_bits;
        }
        s.rows = 0;
        s.count = static_cast<std::uint32_t>(1 + low[0] + high[0]);
        for (std::int64_t z = -low[2]; z <= high[2]; ++z)
            for (std::int64_t y = -low[1]; y <= high[1]; ++y) {
                const std::int64_t first =
                    slot_[item.row] - level.first_slot - low[0] + y * level.row + z * level.layer;
                s.first[s.rows++] = static_cast<std::uint32_t>(first < 0 ? first + level.slots : first);  // if folded
            }
    }

    // Several at a time, so that memory can bring what each of them needs next while it brings that of the others.
    template <class Hit>
    void look_about(const Level& level, std::span<Surroundings> some, Found& found, Hit&& hit) const {
        const std::uint32_t* const slots = slots_.data() + level.first_slot;
        for (Surroundings& s : some) {
            find_surroundings(level, s);
            for (std::uint32_t k = 0; k < s.rows; ++k) __builtin_prefetch(slots + s.first[k]);
        }
        for (const Surroundings& s : some)
            for (std::uint32_t k = 0; k < s.rows; ++k)
                if (s.first[k] < level.slots) __builtin_prefetch(&items_[slots[s.first[k]]]);
        for (const Surroundings& s : some) {
            const Item& item = items_[s.item];
            const __m128i probe = item.probe();
            for (std::uint32_t k = 0; k < s.rows; ++k)
                test_slots(level, item.row, probe, s.first[k], s.count, found, hit);
        }
    }

    template <class Hit>
    void look_elsewhere(const Level& own, std::uint32_t row, const Aabb& box, Found& found, Hit&& hit) const {
        const UnitBox finest = units(box);
        for (const Level& other : levels_)
            if (&other < &own)
                look_around(other, row, finest, found, hit);
            else if (&other > &own)
                look_inside(other, row, finest, hit);
    }

    // The cells with the min corners of all boxes that may overlap this one.
    static std::pair<Cell, Cell> range(const Level& level, const UnitBox& box) {
        Cell first, last;
        for (int axis = 0; axis < 3; ++axis) {
            first[axis] = std::max((box.min[axis] - level.reach) >> cell_bits, level.first[axis]);
            last[axis] = std::min(box.max[axis] >> cell_bits, level.last[axis]);
        }
        return {first, last};
    }

    // In a level whose boxes may be as large as this one.
    template <class Hit>
    void look_around(const Level& level, std::uint32_t row, const UnitBox& finest, Found& found, Hit&& hit) const {
        const UnitBox box = finest.coarser(level.bits);
        const auto [first, last] = range(level, box);
        if (first[0] > last[0]) return;
        const __m128i probe = Item(box, none).probe();
        const auto count = static_cast<std::uint32_t>(last[0] - first[0] + 1);
        for (std::int64_t z = first[2]; z <= last[2]; ++z)
            for (std::int64_t y = first[1]; y <= last[1]; ++y)
                test_slots(level, row, probe, level.slot(first[0], y, z), count, found, hit);
    }

    // In a finer level: 16 bits may not do, and most boxes of these cells do overlap this one.
    template <class Hit>
    void look_inside(const Level& level, std::uint32_t row, const UnitBox& finest, Hit&& hit) const {
        const auto report = [&](std::uint32_t begin, std::uint32_t end) {
            for (std::uint32_t i = begin; i < end; ++i)
                if (items_[i].row != none) hit(row, items_[i].row, false);
        };
        if (level.folded) return report(slots_[level.first_slot], end_of(level));
        const auto [first, last] = range(level, finest.coarser(level.bits));
        if (first[0] > last[0]) return;
        for (std::int64_t z = first[2]; z <= last[2]; ++z)
            for (std::int64_t y = first[1]; y <= last[1]; ++y)
                report(slots_[level.first_slot + level.slot(first[0], y, z)],
                       slots_[level.first_slot + level.slot(last[0], y, z) + 1]);
    }

    // Up to three slots in a row, which may begin or end beyond the last one.
    template <class Hit>
    void test_slots(const Level& level, std::uint32_t row, __m128i probe, std::uint32_t first, std::uint32_t count,
                    Found& found, Hit&& hit) const {
        const std::uint32_t* const slots = slots_.data() + level.first_slot;
        if (first + count <= level.slots)
            return test(level, row, probe, slots[first], slots[first + count], found, hit);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t slot = (first + i) % level.slots;
            test(level, row, probe, slots[slot], slots[slot + 1], found, hit);
        }
    }

    // Items are tested by fours, because how many there are cannot be predicted.
    template <class Hit>
    void test(const Level& level, std::uint32_t row, __m128i probe, std::uint32_t begin, std::uint32_t end,
              Found& found, Hit&& hit) const {
        constexpr int apart = 0x3f, touching = 0x3f00;  // six differences each
        constexpr std::uint32_t step = 4;
        for (std::uint32_t i = begin; i < end; i += step) {
            if (found.count > Found::capacity - step) found.empty_into(hit);
            for (std::uint32_t k = i; k < i + step; ++k) {
                const __m128i depth = _mm_sub_epi16(probe, items_[k].load());
                const int marks =
                    _mm_movemask_epi8(_mm_packs_epi16(depth, _mm_cmpeq_epi16(depth, _mm_setzero_si128())));
                found.candidates[found.count] = {row, items_[k].row, !level.folded && (marks & touching) == 0};
                found.count += (k < end) & ((marks & apart) == 0);
            }
        }
    }

    Vec3 origin_ = Vec3::Zero();
    Aabb corners_;  // of the min corners
    double least_size_ = 0;
    double units_per_size_ = 0;  // of the finest level
    bool crowded_ = false;       // cells larger than boxes need are not to be tried
    std::array<SizeClass, 2048> classes_;
    std::size_t first_class_ = 0, last_class_ = classes_.size() - 1;  // in use: outside of them all is empty
    std::vector<Level> levels_;
    std::vector<std::uint32_t> slots_;
    std::vector<Item> items_, unsorted_;
    std::vector<std::uint32_t> where_;  // of the i-th box in items_
    std::vector<std::uint32_t> slot_;   // of the i-th box
};

}  // namespace kolize
