// Contacts of bounding volumes in place of the bodies.
//
// Every shape is enclosed once; a pair then is what the two volumes are where the bodies stand: two spheres, two
// boxes, or along which of the axes that tell them apart they overlap least. A half-space stays one.
#include <kolize/bounding_volumes.h>
#include <kolize/narrowphase.h>
#include <kolize/plugin.h>

#include <algorithm>
#include <stdexcept>

namespace {

using namespace kolize;

constexpr std::size_t max_chunks = 32;

void require_finite_pose(const World& world, std::uint32_t body) {
    if (!world.position[body].allFinite() || !world.orientation[body].coeffs().allFinite())
        throw std::invalid_argument("body " + std::to_string(body) + " has a pose that is not finite");
}

class BoundingVolume final : public Narrowphase {
public:
    static void parameters(Parameters<BoundingVolume>& p) {
        p.add("volume", &BoundingVolume::volume_)
            .choices({"sphere", "aabb", "obb", "kdop18", "kdop26"})
            .doc("What every body is taken for. aabb and the k-DOPs have the axes of the world.");
    }

    Detail gives() const override { return Detail::normal; }

    void attach(Host& host) override {
        Narrowphase::attach(host);
        rows_.resize(max_chunks);
        for (auto& rows : rows_) rows.reserve(256);
    }

    void prepare(const World& world) override {
        shapes_.clear();
        for (const Shape& shape : world.shapes) shapes_.push_back(fit_volume(shape, volume_kind(volume_)));
    }

    void find_contacts(const NarrowphaseInput& input, Contacts& contacts) override {
        const std::size_t count = input.pairs.size();
        const std::size_t grain = std::max<std::size_t>(16, (count + max_chunks - 1) / max_chunks);
        host().parallel_for(count, grain, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            rows_[chunk].clear();
            for (std::size_t i = begin; i < end; ++i)
                collide(input.world, input.pairs[i], input.detail[i], rows_[chunk]);
        });
        for (std::size_t chunk = 0; chunk < Host::chunk_count(count, grain); ++chunk)
            contacts.rows.insert(contacts.rows.end(), rows_[chunk].begin(), rows_[chunk].end());
    }

private:
    PlacedVolume placed(const World& world, std::uint32_t body) const {
        require_finite_pose(world, body);
        return place_volume(shapes_[world.shape[body]], world.position[body],
                            world.orientation[body].toRotationMatrix());
    }

    void collide(const World& world, const Pair& pair, Detail detail, std::vector<Contact>& rows) const {
        const auto found = volume_contact(placed(world, pair.a), placed(world, pair.b));
        if (!found) return;
        Contact& row = rows.emplace_back();
        row.a = pair.a;
        row.b = pair.b;
        if (detail == Detail::overlap) return;
        row.normal = found->normal;
        row.depth = found->depth;
        row.arm_a = found->point;
        row.arm_b = found->point - (world.position[pair.b] - world.position[pair.a]);
    }

    std::string volume_ = "obb";
    std::vector<ShapeVolume> shapes_;         // by shape of the world
    std::vector<std::vector<Contact>> rows_;  // by chunk of pairs
};

}  // namespace

KOLIZE_PLUGIN(BoundingVolume, .name = "bounding_volume",
              .summary = "contacts of bounding spheres, boxes or k-DOPs in place of the bodies",
              .source = "Ericson, Real-Time Collision Detection, 2005, chapter 4",
              .cost =
                  "Below a microsecond a pair of spheres or boxes; aabb and k-DOPs turn the corners of each mesh for "
                  "every pair. Fitting small boxes around large meshes takes seconds before the first step.",
              .accuracy =
                  "Of volumes, not of surfaces: bodies collide before they touch, as far as their volumes stand "
                  "out. Exact are balls as spheres, and boxes as obb; a ball as obb is a cube that turns with "
                  "it. A k-DOP may collide with a sphere or a turned box that it only nearly touches. With aabb "
                  "and k-DOPs the answer depends on how bodies are turned to the world's axes.",
              .choose =
                  "Choose it where a bounce off the bounds is all that is wanted, as with balls; take moller where "
                  "shapes matter.",
              .capabilities = {.shape_kinds = all_shape_kinds | bit(ShapeKind::capsule),
                               .gives = Detail::normal,
                               .bounding_spheres = true})
