// bench_mesh_pairs: a mesh against a moved copy of itself, in kolize and in other libraries, one thread.
//
// Every contestant is asked twice about every pose: do the two touch (it may stop at the first pair of triangles), and
// which triangles intersect. On some of the poses its pairs are compared with an exact oracle's.
#include "mesh_pairs_rivals.h"

#include <kolize/mesh_io.h>
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin_library.h>
#include <kolize/simulation.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

namespace {

using bench::MeshQuery;
using bench::TrianglePairs;
using kolize::Transform;
using kolize::TriangleSoup;
using kolize::Vec3;
using Poses = std::vector<Transform>;

class Plugin final : public MeshQuery {
public:
    Plugin(const std::string& plugin, const TriangleSoup& surface, const kolize::PluginLibrary& library,
           kolize::Host& host)
        : stage_(library.make<kolize::Narrowphase>({.plugin = plugin, .where = {}, .settings = {}}, host)),
          triangles_(dynamic_cast<kolize::MeshNarrowphase&>(*stage_)),
          mesh_(kolize::build_mesh(surface)) {
        name = "kolize " + plugin;
        kolize::World world;
        world.shapes.resize(1);
        world.shapes[0].kind = kolize::ShapeKind::mesh;
        world.shapes[0].mesh = mesh_;
        stage_->prepare(world);
    }
    bool overlap(const Transform& copy_to_mesh) override {
        find(copy_to_mesh, true);
        return !found_.hits.empty();
    }
    void intersect(const Transform& copy_to_mesh, TrianglePairs& pairs) override {
        find(copy_to_mesh, false);
        for (const kolize::TriangleHit& hit : found_.hits) pairs.emplace_back(hit.a, hit.b);
    }

private:
    void find(const Transform& copy_to_mesh, bool first_only) {
        found_.clear();
        triangles_.intersect_meshes({*mesh_, *mesh_, copy_to_mesh, 0, 0, first_only}, found_);
    }

    kolize::StagePtr<kolize::Narrowphase> stage_;
    const kolize::MeshNarrowphase& triangles_;
    std::shared_ptr<const kolize::Mesh> mesh_;
    kolize::TriangleHits found_;
};

// A sphere with lobes and ripples, from the six faces of a cube: 12 n^2 triangles.
TriangleSoup bumpy_sphere(int n) {
    TriangleSoup soup;
    std::map<std::array<int, 3>, std::uint32_t> ids;  // by place in the cube's grid
    const auto vertex = [&](const std::array<int, 3>& place) {
        const auto [entry, is_new] = ids.try_emplace(place, static_cast<std::uint32_t>(soup.vertices.size()));
        if (is_new) {
            Vec3 d;
            for (int k = 0; k < 3; ++k) d[k] = std::tan((2.0 * place[k] / n - 1) * std::numbers::pi / 4);
            d.normalize();
            soup.vertices.push_back(
                d * (1 + 0.3 * std::sin(3 * d.x() + 1) * std::cos(4 * d.y()) + 0.15 * std::sin(5 * d.z() + 2 * d.x()) +
                     0.02 * std::sin(25 * d.x()) * std::sin(23 * d.y() + 1) * std::cos(27 * d.z())));
        }
        return entry->second;
    };
    for (int face = 0; face < 6; ++face)
        for (int cell = 0; cell < n * n; ++cell) {
            const auto corner = [&](int u, int v) {
                std::array<int, 3> place;
                place[face / 2] = face % 2 * n;
                place[(face / 2 + 1) % 3] = cell / n + u;
                place[(face / 2 + 2) % 3] = cell % n + v;
                return vertex(place);
            };
            const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
            if (face % 2)
                soup.triangles.insert(soup.triangles.end(), {{a, b, c}, {a, c, d}});
            else
                soup.triangles.insert(soup.triangles.end(), {{a, c, b}, {a, d, c}});
        }
    return soup;
}

// Turned at random and put where the axis-aligned bounding boxes overlap, all such places being as likely.
Poses random_poses(const TriangleSoup& surface, std::size_t count) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(-1, 1);
    kolize::Aabb bounds;
    for (const Vec3& p : surface.vertices) bounds.include(p);
    Poses poses(count);
    for (Transform& pose : poses) {
        const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
        pose.rotation = kolize::Quat(q.normalized()).toRotationMatrix();
        kolize::Aabb turned;
        for (const Vec3& p : surface.vertices) turned.include(pose.rotation * p);
        const Vec3 part(uniform(random), uniform(random), uniform(random));
        pose.translation =
            bounds.center() - turned.center() + part.cwiseProduct(bounds.half_extents() + turned.half_extents());
    }
    return poses;
}

struct Entry {
    std::unique_ptr<MeshQuery> query;
    std::vector<double> yes_no = {}, all = {};  // queries per s, one a round
    std::size_t overlaps = 0;
    std::size_t missed = 0, too_many = 0;  // pairs, against the oracle
};

template <class Ask>
double rate(const Poses& poses, const Ask& ask) {
    const auto start = std::chrono::steady_clock::now();
    for (const Transform& pose : poses) ask(pose);
    return static_cast<double>(poses.size()) /
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Round by round, so that a disturbance of the machine falls on all. The first round warms up.
void measure(std::vector<Entry>& entries, const Poses& poses, int rounds) {
    TrianglePairs pairs;
    for (int round = 0; round <= rounds; ++round)
        for (Entry& entry : entries) {
            entry.overlaps = 0;
            const double yes_no = rate(poses, [&](const auto& pose) { entry.overlaps += entry.query->overlap(pose); });
            const double all = rate(poses, [&](const auto& pose) {
                pairs.clear();
                entry.query->intersect(pose, pairs);
            });
            if (round == 0) continue;
            entry.yes_no.push_back(yes_no);
            entry.all.push_back(all);
        }
}

// Returns the number of pairs that there are.
std::size_t compare_with_oracle(std::vector<Entry>& entries, const TriangleSoup& surface, const Poses& poses) {
    std::size_t total = 0;
    for (const Transform& pose : poses) {
        const TrianglePairs exact = bench::exact_pairs(surface, pose);
        total += exact.size();
        for (Entry& entry : entries) {
            TrianglePairs found, common;
            entry.query->intersect(pose, found);
            std::sort(found.begin(), found.end());
            std::set_intersection(found.begin(), found.end(), exact.begin(), exact.end(), std::back_inserter(common));
            entry.missed += exact.size() - common.size();
            entry.too_many += found.size() - common.size();
        }
    }
    return total;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void print_table(const std::vector<Entry>& entries) {
    const auto reference =
        std::find_if(entries.begin(), entries.end(), [](const Entry& entry) { return entry.query->name == "FCL OBB"; });
    const double yes_no = median(reference->yes_no), all = median(reference->all);
    std::printf("%-22s %10s %8s %10s %8s %9s %8s %9s\n", "", "yes/no /s", "/FCL", "all /s", "/FCL", "overlaps",
                "missed", "too many");
    for (const Entry& entry : entries)
        std::printf("%-22s %10.0f %8.2f %10.0f %8.2f %9zu %8zu %9zu\n", entry.query->name.c_str(), median(entry.yes_no),
                    median(entry.yes_no) / yes_no, median(entry.all), median(entry.all) / all, entry.overlaps,
                    entry.missed, entry.too_many);
}

std::vector<Entry> enter(const TriangleSoup& surface, const kolize::PluginLibrary& library, kolize::Host& host) {
    std::vector<Entry> entries;
    for (const std::string& plugin : library.names(kolize::StageKind::narrowphase))
        entries.push_back({.query = std::make_unique<Plugin>(plugin, surface, library, host)});
    for (auto& rival : bench::rival_queries(surface)) entries.push_back({.query = std::move(rival)});
    return entries;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "A mesh against a moved copy of itself in kolize, FCL, Bullet and ODE. Example: bench_mesh_pairs --mesh x.obj");
    std::string file;
    std::size_t pose_count = 200, oracle_poses = 20;
    int rounds = 5;
    app.add_option("--mesh", file, "a closed mesh; without it, a bumpy sphere of 71,148 triangles");
    app.add_option("--poses", pose_count, "random poses")->check(CLI::Range(1, 1000000))->capture_default_str();
    app.add_option("--oracle", oracle_poses, "poses compared with the exact oracle")->capture_default_str();
    app.add_option("--rounds", rounds, "timed rounds")->check(CLI::Range(1, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        const TriangleSoup surface = file.empty() ? bumpy_sphere(77) : kolize::read_mesh(file);
        const kolize::PluginLibrary library({KOLIZE_PLUGIN_DIR});
        const auto host = kolize::make_host(1);
        std::vector<Entry> entries = enter(surface, library, *host);
        const Poses poses = random_poses(surface, pose_count);
        measure(entries, poses, rounds);
        const Poses judged(poses.begin(),
                           poses.begin() + static_cast<std::ptrdiff_t>(std::min(oracle_poses, pose_count)));
        const std::size_t pairs = compare_with_oracle(entries, surface, judged);
        std::printf(
            "%zu triangles, %zu poses; %zu pairs intersect in the first %zu of them.\n"
            "Debian's libfcl is built with its assertions on; Bullet and Debian's ODE cannot be compared pair by "
            "pair in the same precision.\n\n",
            surface.triangles.size(), poses.size(), pairs, judged.size());
        print_table(entries);
    } catch (const kolize::Error& error) {
        std::fprintf(stderr, "bench_mesh_pairs: %s\n", error.what());
        return 2;
    }
    return 0;
}
