// How the voxel method converges: the same model at several steps.
#pragma once

#include "massprops/model.h"
#include "massprops/options.h"

#include "common.h"

namespace kolize::cli {

struct StudyRow {
    double step = 0;  // the largest spacing of the grid
    MassProperties mass;
    std::uint64_t odd_rays = 0;
    double seconds = 0;
    // Relative to the reference; the tensor by the Frobenius norm, the centre by the diagonal of the bounding box.
    double volume_error = 0, center_error = 0, tensor_error = 0;
};

struct Study {
    MassProperties reference;  // the exact values, or those of the finest step if there are none
    bool reference_is_exact = false;
    std::vector<StudyRow> rows;  // from the largest step to the smallest
    // Slope of log error against log step by least squares, over the errors above rounding; none for fewer than two.
    std::optional<double> volume_order, tensor_order;
};

// Of every step in options.study.
Study run_study(const Model& model, const MassPropsOptions& options);

void print_text(const Study& study, std::ostream& out);
Json to_json(const Study& study);
// A picture of the errors against the step, both axes logarithmic.
std::string plot_svg(const Study& study, const std::string& title);

}  // namespace kolize::cli
