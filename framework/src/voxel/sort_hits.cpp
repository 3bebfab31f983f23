#include <kolize/voxel_mass_properties.h>

#include <utility>

namespace kolize {

namespace {

bool before(const Crossing& a, const Crossing& b) { return a.depth != b.depth ? a.depth < b.depth : a.sign < b.sign; }

// Most lines have two crossings, in an order that no branch predictor can guess; few have many: insertion sort.
void sort_by_depth(std::span<Crossing> line) {
    if (line.size() == 2) {
        const bool swap = before(line[1], line[0]);
        const Crossing first = line[swap], second = line[!swap];
        line[0] = first;
        line[1] = second;
        return;
    }
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Crossing moved = line[i];
        std::size_t k = i;
        for (; k > 0 && before(moved, line[k - 1]); --k) line[k] = line[k - 1];
        line[k] = moved;
    }
}

}  // namespace

void sort_hits(std::span<const LineHit> hits, std::size_t lines, LineCrossings& out) {
    out.end.assign(lines, 0);
    for (const LineHit& hit : hits) ++out.end[hit.line];
    std::uint32_t total = 0;
    for (std::uint32_t& count : out.end) total += std::exchange(count, total);
    if (out.crossings.size() < total) out.crossings.resize(total);
    for (const LineHit& hit : hits) out.crossings[out.end[hit.line]++] = {hit.depth, hit.sign};
    std::uint32_t begin = 0;
    for (const std::uint32_t end : out.end) {
        if (end - begin > 1) sort_by_depth({&out.crossings[begin], end - begin});
        begin = end;
    }
}

}  // namespace kolize
