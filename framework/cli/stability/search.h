// Where along an axis something ceases to hold.
#pragma once

#include "stability/study.h"

namespace kolize::cli::stability {

inline constexpr double resolution = 0.1;  // decades

struct Sample {
    double decades = 0;
    Outcome outcome = {};
};

struct Envelope {
    // The last magnitude below the first failure, to within the resolution; none if it fails at the easy end.
    std::optional<double> holds_to;
    std::optional<Sample> beyond;  // the first failure; none if it holds to the end of the axis
    std::optional<double> again;   // not monotone: it holds again, at last here
    std::optional<Sample> silent;  // the first failure without a message
    int probes = 0;

    bool to_the_end() const { return !beyond; }
};

// Takes samples over the whole axis, halves the interval of the first failure down to the resolution, and looks again
// between the samples below it: a failure that is found there takes the place of the first one.
Envelope find_envelope(const Axis& axis, const std::function<Outcome(double decades)>& probe);

// Along one axis of a study, the others at their usual magnitude.
Envelope find_envelope(const Study& study, const Subject& subject, std::size_t axis);

}  // namespace kolize::cli::stability
