// Running sums over the parts of grid lines that are inside a solid.
#pragma once

#include <kolize/voxel_mass_properties.h>

namespace kolize {

// Where a line is, seen along it: x is the coordinate along the line, y along the columns and z along the rows, all
// from the reference point.
struct LinePlace {
    double y, z;
};

// Part of a line, or its cells: their amount (length in m, or number), and the sums of x and of x^2 over it.
struct Run {
    double amount, first, second;
};

inline Run length_run(double begin, double end) {
    const double length = end - begin;
    return {length, length * 0.5 * (begin + end), length * (begin * begin + begin * end + end * end) / 3};
}

// Cells at x, x + h, ...: arithmetic series in closed form.
inline Run cell_run(double x, double count, double h) {
    const double mean = x + 0.5 * (count - 1) * h;
    return {count, count * mean, count * (mean * mean + h * h * (count * count - 1) / 12)};
}

// Real is what the sums run in. The inertia about each axis is summed as such, not put together from second moments
// afterwards: it is single sums that stand still when they run in float. Axes are those of LinePlace.
template <class Real>
struct LineSums {
    double amount = 0;                                              // cells, or m
    Eigen::Matrix<Real, 3, 1> first = decltype(first)::Zero();      // of the position
    Eigen::Matrix<Real, 3, 1> inertia = decltype(inertia)::Zero();  // about each axis
    Eigen::Matrix<Real, 3, 1> product = decltype(product)::Zero();  // [i]: of the other two coordinates

    // own_y, own_z: square of the gyration radius of the run across the line.
    void add(const LinePlace& at, const Run& run, double own_y, double own_z) {
        const double yy = run.amount * (at.y * at.y + own_y), zz = run.amount * (at.z * at.z + own_z);
        add_linear(at, run);
        inertia[0] += static_cast<Real>(yy + zz);
        inertia[1] += static_cast<Real>(run.second + zz);
        inertia[2] += static_cast<Real>(run.second + yy);
    }

    // Cell by cell where terms differ from cell to cell, as a loop over voxels does. sign: -1 takes them away.
    void add_cells_singly(const LinePlace& at, double x, double count, double h, Real sign) {
        const Run run = cell_run(x, count, h);
        add_linear(at, {sign * run.amount, sign * run.first, sign * run.second});
        const Real y = static_cast<Real>(at.y), z = static_cast<Real>(at.z);
        inertia[0] += sign * static_cast<Real>(count) * (y * y + z * z);
        Real about_j = inertia[1], about_k = inertia[2];
        for (double cell = 0; cell < count; ++cell) {
            const Real here = static_cast<Real>(x + cell * h);
            about_j += sign * (here * here + z * z);
            about_k += sign * (here * here + y * y);
        }
        inertia[1] = about_j;
        inertia[2] = about_k;
    }

    void add(const LineSums& other) {
        amount += other.amount;
        first += other.first;
        inertia += other.inertia;
        product += other.product;
    }

private:
    void add_linear(const LinePlace& at, const Run& run) {
        amount += run.amount;
        first[0] += static_cast<Real>(run.first);
        first[1] += static_cast<Real>(run.amount * at.y);
        first[2] += static_cast<Real>(run.amount * at.z);
        product[0] += static_cast<Real>(run.amount * at.y * at.z);
        product[1] += static_cast<Real>(run.first * at.z);
        product[2] += static_cast<Real>(run.first * at.y);
    }
};

}  // namespace kolize
