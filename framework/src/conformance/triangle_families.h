// Pairs of triangles in the situations in which triangle tests err. Each family makes hits and misses.
#pragma once

#include <kolize/mesh_narrowphase.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace kolize {

class PairMaker {
public:
    explicit PairMaker(std::uint64_t seed) : random_(seed) {}

    TrianglePair random() {
        TrianglePair pair;
        for (int k = 0; k < 3; ++k) {
            pair.a[k] = any();
            pair.b[k] = any();
        }
        return pair;
    }

    // Corners are multiples of 4 units: quarters of sides, and sums of them, are exact.
    TrianglePair corner_touches() {
        TrianglePair pair = on_grid();
        pair.b[below(3)] = quarters(pair.a);
        return pair;
    }
    TrianglePair sides_touch() {
        TrianglePair pair = on_grid();
        const Vec3 touch = (3 * pair.a[0] + pair.a[1]) / 4;
        pair.b[1] = 2 * touch - pair.b[0];  // touch is the middle of b's side
        if (below(4) == 0) pair.b[1] = touch + (touch - pair.b[0]) / 4 * below(3);
        return pair;
    }
    TrianglePair shared_corner() {
        TrianglePair pair = random();
        pair.b[below(3)] = pair.a[below(3)];
        return pair;
    }
    TrianglePair shared_side() {
        TrianglePair pair = random();
        const int i = below(3), j = below(3);
        pair.b[j] = pair.a[i];
        pair.b[(j + 1) % 3] = pair.a[(i + 1) % 3];
        return pair;
    }

    // On a lattice in a plane through whole numbers: overlapping, touching and apart.
    TrianglePair in_one_plane() {
        const Vec3 origin = grid_point(), u = grid_point(), v = grid_point();
        TrianglePair pair;
        const int shift = below(5);
        for (int k = 0; k < 3; ++k) {
            pair.a[k] = origin + below(5) * u + below(5) * v;
            pair.b[k] = origin + (below(5) + shift) * u + below(5) * v;
        }
        return pair;
    }
    TrianglePair nearly_in_one_plane() {
        const double off = power_of_ten(-1, -16);
        const Mat3 turn = any_rotation();
        TrianglePair pair = random();
        for (int k = 0; k < 3; ++k) {
            pair.a[k].z() = 0;
            pair.b[k].z() *= off;
            pair.a[k] = turn * pair.a[k];
            pair.b[k] = turn * pair.b[k];
        }
        return pair;
    }
    TrianglePair slivers() {
        TrianglePair pair = random();
        make_sliver(pair.a);
        if (below(2)) make_sliver(pair.b);
        // So thin that only an aimed one is hit: b's side goes through a's middle, more or less.
        const Vec3 aim = (pair.a[0] + pair.a[1] + pair.a[2]) / 3 + any() * power_of_ten(-1, -15);
        pair.b[1] = 2 * aim - pair.b[0];
        return pair;
    }
    TrianglePair far_away() {
        TrianglePair pair = below(2) ? random() : corner_touches();
        const Vec3 offset = any() * power_of_ten(3, 12);
        for (int k = 0; k < 3; ++k) {
            pair.a[k] += offset;
            pair.b[k] += offset;
        }
        return pair;
    }
    TrianglePair without_area() {
        TrianglePair pair = on_grid();
        if (below(2)) pair.b[below(3)] = quarters(pair.a);
        flatten(pair.b);
        if (below(3) == 0) flatten(pair.a);
        return pair;
    }
    // A corner on the other triangle or on the line of one of its sides, but for a unit in the last place.
    TrianglePair one_ulp_off() {
        TrianglePair pair = random();
        Vec3 p = quarters(pair.a);
        for (double& x : p) x = std::nextafter(x, below(2) ? 10.0 : -10.0);
        pair.b[below(3)] = p;
        return pair;
    }
    TrianglePair tiny_or_huge() {
        TrianglePair pair = below(3) == 0 ? one_ulp_off() : below(2) ? corner_touches() : random();
        const double scale = std::ldexp(1.0, below(2) ? -400 - below(600) : 400 + below(600));
        for (int k = 0; k < 3; ++k) {
            pair.a[k] *= scale;
            pair.b[k] *= scale;
        }
        return pair;
    }

private:
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    Vec3 any() {
        const double x = uniform(), y = uniform(), z = uniform();
        return {x, y, z};
    }
    Vec3 grid_point() {
        const int x = below(33), y = below(33), z = below(33);
        return Vec3(x - 16, y - 16, z - 16) * 4;
    }
    double power_of_ten(int from, int to) { return std::pow(10.0, from + (to - from) * (1 + uniform()) / 2); }
    Mat3 any_rotation() {
        std::normal_distribution<double> normal;
        const double w = normal(random_), x = normal(random_), y = normal(random_), z = normal(random_);
        return Quat(w, x, y, z).normalized().toRotationMatrix();
    }
    TrianglePair on_grid() {
        TrianglePair pair;
        for (int k = 0; k < 3; ++k) {
            pair.a[k] = grid_point();
            pair.b[k] = grid_point();
        }
        return pair;
    }
    // In the plane of the triangle: inside, on a side, at a corner, or a little outside.
    Vec3 quarters(const Vec3 (&t)[3]) {
        const int s = below(6) - 1, r = below(6) - 1;
        return t[0] + 0.25 * s * (t[1] - t[0]) + 0.25 * r * (t[2] - t[0]);
    }
    void make_sliver(Vec3 (&t)[3]) { t[2] = t[0] + uniform() * (t[1] - t[0]) + any() * power_of_ten(-1, -15); }
    // To a segment or, now and then, a point.
    void flatten(Vec3 (&t)[3]) {
        t[2] = below(2) ? t[0] : Vec3((t[0] + t[1]) / 2);
        if (below(4) == 0) t[0] = t[1] = t[2];
    }

    std::mt19937_64 random_;
};

struct TriangleFamily {
    std::string name;
    TrianglePair (PairMaker::*make)();
};

inline const std::vector<TriangleFamily>& triangle_families() {
    static const std::vector<TriangleFamily> families{{"random", &PairMaker::random},
                                                      {"corner touches", &PairMaker::corner_touches},
                                                      {"sides touch", &PairMaker::sides_touch},
                                                      {"shared corner", &PairMaker::shared_corner},
                                                      {"shared side", &PairMaker::shared_side},
                                                      {"in one plane", &PairMaker::in_one_plane},
                                                      {"nearly in one plane", &PairMaker::nearly_in_one_plane},
                                                      {"slivers", &PairMaker::slivers},
                                                      {"far away", &PairMaker::far_away},
                                                      {"without area", &PairMaker::without_area},
                                                      {"one ulp off", &PairMaker::one_ulp_off},
                                                      {"tiny or huge", &PairMaker::tiny_or_huge}};
    return families;
}

inline std::vector<TrianglePair> triangle_pairs(const TriangleFamily& family, int count, std::uint64_t seed) {
    PairMaker maker(seed);
    std::vector<TrianglePair> pairs;
    for (int i = 0; i < count; ++i) pairs.push_back((maker.*family.make)());
    return pairs;
}

}  // namespace kolize
