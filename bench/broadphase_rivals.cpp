#include "broadphase_rivals.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/box.h>

namespace bench {

namespace {

using kolize::Aabb;
using kolize::Pair;

btVector3 to_bullet(const kolize::Vec3& v) { return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())}; }

Pair ordered(std::size_t a, std::size_t b) {
    return {static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b))};
}

// The standard use: proxies with a margin, and a pair cache that lives from frame to frame. It also holds pairs whose
// boxes are apart by less than the margin or have parted lately, so each of its pairs is tested.
class BulletBroadphase final : public Contestant {
public:
    explicit BulletBroadphase(const Frame& first) {
        name = "Bullet btDbvtBroadphase";
        rows_.resize(first.size());
        for (std::size_t row = 0; row < first.size(); ++row) {
            rows_[row] = row;
            proxies_.push_back(broadphase_.createProxy(to_bullet(first[row].min), to_bullet(first[row].max), 0,
                                                       &rows_[row], 1, 1, nullptr));
        }
    }
    ~BulletBroadphase() override {
        for (btBroadphaseProxy* proxy : proxies_) broadphase_.destroyProxy(proxy, nullptr);
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        for (std::size_t row = 0; row < frame.size(); ++row)
            broadphase_.setAabb(proxies_[row], to_bullet(frame[row].min), to_bullet(frame[row].max), nullptr);
        broadphase_.calculateOverlappingPairs(nullptr);
        const btBroadphasePairArray& cached = broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < cached.size(); ++i) {
            const Pair pair = ordered(row_of(cached[i].m_pProxy0), row_of(cached[i].m_pProxy1));
            if (frame[pair.a].overlaps(frame[pair.b])) pairs.push_back(pair);
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

// The tree alone: exact boxes, every leaf updated, the tree collided with itself.
class BulletTree final : public Contestant {
public:
    explicit BulletTree(const Frame& first) {
        name = "Bullet btDbvt";
        for (std::size_t row = 0; row < first.size(); ++row)
            leaves_.push_back(tree_.insert(volume(first[row]), reinterpret_cast<void*>(row)));
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        for (std::size_t row = 0; row < frame.size(); ++row) {
            btDbvtVolume box = volume(frame[row]);
            tree_.update(leaves_[row], box);
        }
        tree_.optimizeIncremental(1 + static_cast<int>(frame.size()) / 100);
        Collector collector(pairs);
        tree_.collideTT(tree_.m_root, tree_.m_root, collector);
    }

private:
    struct Collector final : btDbvt::ICollide {
        explicit Collector(std::vector<Pair>& p) : pairs(p) {}
        void Process(const btDbvtNode* a, const btDbvtNode* b) override {
            pairs.push_back(ordered(reinterpret_cast<std::size_t>(a->data), reinterpret_cast<std::size_t>(b->data)));
        }
        std::vector<Pair>& pairs;
    };
    static btDbvtVolume volume(const Aabb& box) { return btDbvtVolume::FromMM(to_bullet(box.min), to_bullet(box.max)); }

    btDbvt tree_;
    std::vector<btDbvtNode*> leaves_;
};

template <class Manager>
class FclBroadphase final : public Contestant {
public:
    FclBroadphase(const char* title, const Frame& first) {
        name = title;
        const auto box = std::make_shared<fcl::Boxd>(1, 1, 1);
        std::vector<fcl::CollisionObjectd*> all;
        for (std::size_t row = 0; row < first.size(); ++row) {
            objects_.push_back(std::make_unique<fcl::CollisionObjectd>(box));
            objects_.back()->setUserData(reinterpret_cast<void*>(row));
            place(row, first[row]);
            all.push_back(objects_.back().get());
        }
        manager_.registerObjects(all);
        manager_.setup();
    }
    void find_pairs(const Frame& frame, std::vector<Pair>& pairs) override {
        for (std::size_t row = 0; row < frame.size(); ++row) place(row, frame[row]);
        manager_.update();
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
    Manager manager_;
};

}  // namespace

std::vector<std::unique_ptr<Contestant>> rival_broadphases(const Frame& first) {
    using Tree = fcl::DynamicAABBTreeCollisionManagerd;
    using TreeArray = fcl::DynamicAABBTreeCollisionManager_Arrayd;
    std::vector<std::unique_ptr<Contestant>> rivals;
    rivals.push_back(std::make_unique<BulletBroadphase>(first));
    rivals.push_back(std::make_unique<BulletTree>(first));
    rivals.push_back(std::make_unique<FclBroadphase<Tree>>("FCL DynamicAABBTree", first));
    rivals.push_back(std::make_unique<FclBroadphase<TreeArray>>("FCL DynamicAABBTree_Array", first));
    return rivals;
}

}  // namespace bench
