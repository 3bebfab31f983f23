#include "broadphase_rivals.h"

#include <kolize/error.h>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <CGAL/box_intersection_d.h>
#include <embree3/rtcore.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/box.h>

#include <cmath>

namespace bench {

namespace {

using kolize::Aabb;
using kolize::Pair;

float rounded_down(double x) {
    const auto nearest = static_cast<float>(x);
    return nearest > x ? std::nextafter(nearest, -HUGE_VALF) : nearest;
}

float rounded_up(double x) { return -rounded_down(-x); }

// Libraries that compute in float get boxes that are rounded outwards, and their pairs are tested.
struct FloatBox {
    explicit FloatBox(const Aabb& box) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = rounded_down(box.min[axis]);
            max[axis] = rounded_up(box.max[axis]);
        }
    }
    btVector3 bullet_min() const { return {min[0], min[1], min[2]}; }
    btVector3 bullet_max() const { return {max[0], max[1], max[2]}; }

    float min[3], max[3];
};

Pair ordered(std::size_t a, std::size_t b) {
    return {static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b))};
}

// The standard use: proxies with a margin, and a pair cache that lives from frame to frame. It also holds pairs whose
// boxes are apart by less than the margin or have parted lately, so each of its pairs is tested.
class BulletBroadphase final : public Contestant {
public:
    explicit BulletBroadphase(const Frame& first) {
        rows_.resize(first.boxes.size());
        for (std::size_t row = 0; row < rows_.size(); ++row) {
            rows_[row] = row;
            const FloatBox box(first.boxes[row]);
            proxies_.push_back(
                broadphase_.createProxy(box.bullet_min(), box.bullet_max(), 0, &rows_[row], 1, 1, nullptr));
        }
    }
    ~BulletBroadphase() override {
        for (btBroadphaseProxy* proxy : proxies_) broadphase_.destroyProxy(proxy, nullptr);
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        for (const std::uint32_t row : frame.moved) {
            const FloatBox box(frame.boxes[row]);
            broadphase_.setAabb(proxies_[row], box.bullet_min(), box.bullet_max(), nullptr);
        }
        broadphase_.calculateOverlappingPairs(nullptr);
        const btBroadphasePairArray& cached = broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < cached.size(); ++i) {
            const Pair pair = ordered(row_of(cached[i].m_pProxy0), row_of(cached[i].m_pProxy1));
            if (frame.boxes[pair.a].overlaps(frame.boxes[pair.b])) pairs.push_back(pair);
        }
    }

private:
    static std::size_t row_of(const btBroadphaseProxy* proxy) {
        return *static_cast<const std::size_t*>(proxy->m_clientObject);
    }

    btDbvtBroadphase broadphase_;
    std::vector<std::size_t> rows_;
    std::vector<btBroadphaseProxy*> proxies_;
};

// The tree alone: boxes without a margin, every leaf that moved updated, the tree collided with itself.
class BulletTree final : public Contestant {
public:
    explicit BulletTree(const Frame& first) {
        for (std::size_t row = 0; row < first.boxes.size(); ++row)
            leaves_.push_back(tree_.insert(volume(first.boxes[row]), reinterpret_cast<void*>(row)));
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        for (const std::uint32_t row : frame.moved) {
            btDbvtVolume box = volume(frame.boxes[row]);
            tree_.update(leaves_[row], box);
        }
        tree_.optimizeIncremental(1 + static_cast<int>(frame.moved.size()) / 100);
        Collector collector(frame, pairs);
        tree_.collideTT(tree_.m_root, tree_.m_root, collector);
    }

private:
    struct Collector final : btDbvt::ICollide {
        Collector(const Frame& f, std::vector<Pair>& p) : frame(f), pairs(p) {}
        void Process(const btDbvtNode* a, const btDbvtNode* b) override {
            const Pair pair = ordered(reinterpret_cast<std::size_t>(a->data), reinterpret_cast<std::size_t>(b->data));
            if (frame.boxes[pair.a].overlaps(frame.boxes[pair.b])) pairs.push_back(pair);
        }
        const Frame& frame;
        std::vector<Pair>& pairs;
    };
    static btDbvtVolume volume(const Aabb& bounds) {
        const FloatBox box(bounds);
        return btDbvtVolume::FromMM(box.bullet_min(), box.bullet_max());
    }

    btDbvt tree_;
    std::vector<btDbvtNode*> leaves_;
};

template <class Manager>
class FclBroadphase final : public Contestant {
public:
    explicit FclBroadphase(const Frame& first) {
        std::vector<fcl::CollisionObjectd*> all;
        for (std::size_t row = 0; row < first.boxes.size(); ++row) {
            const kolize::Vec3 sides = first.boxes[row].max - first.boxes[row].min;
            objects_.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(sides)));
            objects_.back()->setUserData(reinterpret_cast<void*>(row));
            place(row, first.boxes[row]);
            all.push_back(objects_.back().get());
        }
        manager_.registerObjects(all);
        manager_.setup();
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        moved_.clear();
        for (const std::uint32_t row : frame.moved) {
            place(row, frame.boxes[row]);
            moved_.push_back(objects_[row].get());
        }
        if (moved_.size() == objects_.size())
            manager_.update();
        else
            manager_.update(moved_);
        manager_.collide(&pairs, collect);
    }

private:
    void place(std::size_t row, const Aabb& box) {
        objects_[row]->setTranslation(box.center());
        objects_[row]->computeAABB();
    }
    static bool collect(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* pairs) {
        static_cast<std::vector<Pair>*>(pairs)->push_back(
            ordered(reinterpret_cast<std::size_t>(a->getUserData()), reinterpret_cast<std::size_t>(b->getUserData())));
        return false;  // go on
    }

    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
    std::vector<fcl::CollisionObjectd*> moved_;
    Manager manager_;
};

// Nothing is kept from frame to frame. It sorts pointers to the boxes, as its manual recommends.
class CgalBoxes final : public Contestant {
public:
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        boxes_.clear();
        pointers_.clear();
        for (const Aabb& box : frame.boxes)
            boxes_.emplace_back(CGAL::Bbox_3(box.min.x(), box.min.y(), box.min.z(),  //
                                             box.max.x(), box.max.y(), box.max.z()),
                                &box);
        for (const Box& box : boxes_) pointers_.push_back(&box);
        const Aabb* const first = frame.boxes.data();
        CGAL::box_self_intersection_d(
            pointers_.begin(), pointers_.end(),
            [&](const Box* a, const Box* b) {
                pairs.push_back(ordered(static_cast<std::size_t>(a->handle() - first),
                                        static_cast<std::size_t>(b->handle() - first)));
            },
            std::ptrdiff_t{100});
    }

private:
    using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Aabb*>;

    std::vector<Box> boxes_;
    std::vector<const Box*> pointers_;
};

// The boxes are the primitives of one user geometry, whose hierarchy is refitted.
class EmbreeScene final : public Contestant {
public:
    explicit EmbreeScene(const Frame& first) {
        boxes_ = &first.boxes;
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(first.boxes.size()));
        rtcSetGeometryUserData(geometry_, this);
        rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry_, [](const RTCIntersectFunctionNArguments*) {});
        rtcSetGeometryOccludedFunction(geometry_, [](const RTCOccludedFunctionNArguments*) {});
        rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
        rtcCommitGeometry(geometry_);
        rtcAttachGeometry(scene_, geometry_);
        rtcCommitScene(scene_);
        if (const RTCError error = rtcGetDeviceError(device_))
            throw kolize::Error("Embree takes no user geometry (error " + std::to_string(error) + ")");
    }
    ~EmbreeScene() override {
        rtcReleaseGeometry(geometry_);
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        boxes_ = &frame.boxes;
        pairs_ = &pairs;
        rtcCommitGeometry(geometry_);
        rtcCommitScene(scene_);
        rtcCollide(scene_, scene_, collect, this);
    }

private:
    static void bounds(const RTCBoundsFunctionArguments* arguments) {
        const FloatBox box((*static_cast<EmbreeScene*>(arguments->geometryUserPtr)->boxes_)[arguments->primID]);
        *arguments->bounds_o = {box.min[0], box.min[1], box.min[2], 0, box.max[0], box.max[1], box.max[2], 0};
    }
    // Told of every pair in both orders, and of every box with itself.
    static void collect(void* self, RTCCollision* collisions, unsigned count) {
        const EmbreeScene& scene = *static_cast<EmbreeScene*>(self);
        const std::vector<Aabb>& boxes = *scene.boxes_;
        for (unsigned i = 0; i < count; ++i) {
            const Pair pair{collisions[i].primID0, collisions[i].primID1};
            if (pair.a < pair.b && boxes[pair.a].overlaps(boxes[pair.b])) scene.pairs_->push_back(pair);
        }
    }

    RTCDevice device_ = rtcNewDevice("threads=1");
    RTCScene scene_ = rtcNewScene(device_);
    RTCGeometry geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    const std::vector<Aabb>* boxes_ = nullptr;
    std::vector<Pair>* pairs_ = nullptr;
};

}  // namespace

std::vector<std::unique_ptr<Contestant>> rival_broadphases(const Frame& first,
                                                           const std::function<bool(const std::string&)>& wanted) {
    using Tree = fcl::DynamicAABBTreeCollisionManagerd;
    using TreeArray = fcl::DynamicAABBTreeCollisionManager_Arrayd;
    using Make = std::function<std::unique_ptr<Contestant>()>;
    const std::pair<const char*, Make> all[] = {
        {"Bullet btDbvtBroadphase", [&] { return std::make_unique<BulletBroadphase>(first); }},
        {"Bullet btDbvt", [&] { return std::make_unique<BulletTree>(first); }},
        {"FCL DynamicAABBTree", [&] { return std::make_unique<FclBroadphase<Tree>>(first); }},
        {"FCL DynamicAABBTree_Array", [&] { return std::make_unique<FclBroadphase<TreeArray>>(first); }},
        {"CGAL box_intersection_d", [&] { return std::make_unique<CgalBoxes>(); }},
        {"Embree rtcCollide", [&] { return std::make_unique<EmbreeScene>(first); }},
    };
    std::vector<std::unique_ptr<Contestant>> rivals;
    for (const auto& [name, make] : all) {
        if (!wanted(name)) continue;
        rivals.push_back(make());
        rivals.back()->name = name;
    }
    return rivals;
}

}  // namespace bench
