// Oracle: the volume that two convex polyhedra share, by brute force over their face planes.
#pragma once

#include <kolize/math.h>

#include <algorithm>
#include <vector>

namespace oracle {

using kolize::Vec3;

struct HalfSpace {
    Vec3 normal;  // unit, outward
    double offset = 0;
};

inline std::vector<HalfSpace> box_faces(const Vec3& half, const kolize::Mat3& axes, const Vec3& center) {
    std::vector<HalfSpace> faces;
    for (int k = 0; k < 3; ++k)
        for (const double side : {-1.0, 1.0}) {
            const Vec3 n = side * axes.col(k);
            faces.push_back({n, n.dot(center) + half[k]});
        }
    return faces;
}

// Corners of the face of plane i: where it meets two other planes, inside all the rest.
inline std::vector<Vec3> face_corners(const std::vector<HalfSpace>& planes, std::size_t i) {
    std::vector<Vec3> corners;
    for (std::size_t j = 0; j < planes.size(); ++j)
        for (std::size_t k = j + 1; k < planes.size(); ++k) {
            if (i == j || i == k) continue;
            kolize::Mat3 m;
            m << planes[i].normal.transpose(), planes[j].normal.transpose(), planes[k].normal.transpose();
            if (std::abs(m.determinant()) < 1e-9) continue;
            const Vec3 p = m.inverse() * Vec3(planes[i].offset, planes[j].offset, planes[k].offset);
            if (std::all_of(planes.begin(), planes.end(),
                            [&](const HalfSpace& h) { return h.normal.dot(p) <= h.offset + 1e-9; }))
                corners.push_back(p);
        }
    return corners;
}

// Volume of the intersection of all half-spaces (bounded): cones from the origin over the faces.
inline double volume(const std::vector<HalfSpace>& planes) {
    double sum = 0;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        std::vector<Vec3> corners = face_corners(planes, i);
        if (corners.size() < 3) continue;
        Vec3 middle = Vec3::Zero();
        for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
        const Vec3 u = (corners[0] - middle).normalized(), v = planes[i].normal.cross(u);
        std::sort(corners.begin(), corners.end(), [&](const Vec3& p, const Vec3& q) {
            return std::atan2(v.dot(p - middle), u.dot(p - middle)) < std::atan2(v.dot(q - middle), u.dot(q - middle));
        });
        double area = 0;
        for (std::size_t k = 0; k < corners.size(); ++k)
            area += 0.5 * planes[i].normal.dot((corners[k] - middle).cross(corners[(k + 1) % corners.size()] - middle));
        sum += area * planes[i].offset / 3;
    }
    return sum;
}

inline double overlap_volume(std::vector<HalfSpace> a, const std::vector<HalfSpace>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return volume(a);
}

// Length of the part of the line p + t direction inside all half-spaces; negative where the line misses them.
inline double chord(const std::vector<HalfSpace>& planes, const Vec3& direction, const Vec3& p) {
    double from = -1e9, to = 1e9;
    for (const HalfSpace& h : planes) {
        const double slope = h.normal.dot(direction), gap = h.offset - h.normal.dot(p);
        if (slope > 0) to = std::min(to, gap / slope);
        if (slope < 0) from = std::max(from, gap / slope);
    }
    return to - from;
}

template <class Function>
double maximum(Function&& f, double low, double high) {
    for (int i = 0; i < 50; ++i) {  // (2/3)^50 = 1.6e-9 of the interval is left
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        const bool rising = f(a) < f(b);
        (rising ? low : high) = rising ? a : b;
    }
    return f(0.5 * (low + high));
}

// The chord is a concave function of where the line stands, so two nested searches find the longest one.
inline double longest_chord(const std::vector<HalfSpace>& planes, const Vec3& direction, const Vec3& start) {
    const Vec3 u = direction.unitOrthogonal(), v = direction.cross(u);
    return maximum(
        [&](double x) {
            return maximum([&](double y) { return chord(planes, direction, start + x * u + y * v); }, -5, 5);
        },
        -5, 5);
}

}  // namespace oracle
