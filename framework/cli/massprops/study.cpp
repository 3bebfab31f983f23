#include "massprops/study.h"

#include "massprops/slow_methods.h"

#include <nlohmann/json.hpp>

namespace kolize::cli {
namespace {

constexpr double rounding = 1e-13;  // errors below say nothing about the order

StudyRow measure(const Model& model, const MassPropsOptions& options, double step) {
    const TimedVoxels voxels = run_voxels(model.surface, options, step);
    StudyRow row;
    row.step = voxels.result.grid.spacing.maxCoeff();
    row.mass = voxels.result.mass;
    row.seconds = voxels.seconds;
    for (const VoxelPass& pass : voxels.result.passes) row.odd_rays += pass.odd_lines;
    return row;
}

void compare(StudyRow& row, const MassProperties& reference, double diagonal) {
    row.volume_error = std::abs(row.mass.volume - reference.volume) / reference.volume;
    row.center_error = (row.mass.center_of_mass - reference.center_of_mass).norm() / diagonal;
    row.tensor_error =
        (row.mass.inertia_over_mass - reference.inertia_over_mass).norm() / reference.inertia_over_mass.norm();
}

std::optional<double> order_of(const std::vector<StudyRow>& rows, double StudyRow::*error) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const StudyRow& row : rows) {
        if (!(row.*error > rounding)) continue;
        const double u = std::log(row.step), v = std::log(row.*error);
        n += 1;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double spread = n * xx - x * x;
    if (n < 2 || !(spread > 0)) return std::nullopt;
    return (n * xy - x * y) / spread;
}

std::string order_between(const StudyRow& coarse, const StudyRow& fine) {
    if (!(coarse.tensor_error > rounding && fine.tensor_error > rounding && coarse.step > fine.step)) return "";
    return number(std::log(coarse.tensor_error / fine.tensor_error) / std::log(coarse.step / fine.step));
}

std::string text(const std::optional<double>& order) { return order ? number(*order) : "none (errors at rounding)"; }

}  // namespace

Study run_study(const Model& model, const MassPropsOptions& options) {
    Study study;
    study.reference_is_exact = model.bounds_volume();
    for (const double step : options.study) study.rows.push_back(measure(model, options, step));
    std::stable_sort(study.rows.begin(), study.rows.end(),
                     [](const auto& a, const auto& b) { return a.step > b.step; });
    study.reference = study.reference_is_exact ? mass_properties(model.surface) : study.rows.back().mass;
    const Aabb box = bounding_box(model.surface.vertices);
    for (StudyRow& row : study.rows) compare(row, study.reference, (box.max - box.min).norm());
    study.volume_order = order_of(study.rows, &StudyRow::volume_error);
    study.tensor_order = order_of(study.rows, &StudyRow::tensor_error);
    return study;
}

void print_text(const Study& study, std::ostream& out) {
    Table table(
        {"step", "volume", "Ixx/m", "Iyy/m", "Izz/m", "volume error", "tensor error", "order", "odd", "time s"});
    const auto add = [&](const std::string& name, const MassProperties& mass, const std::vector<std::string>& rest) {
        const Mat3& inertia = mass.inertia_over_mass;
        std::vector<std::string> row{name, number(mass.volume, 9), number(inertia(0, 0), 9), number(inertia(1, 1), 9),
                                     number(inertia(2, 2), 9)};
        row.insert(row.end(), rest.begin(), rest.end());
        table.add(std::move(row));
    };
    for (std::size_t i = 0; i < study.rows.size(); ++i) {
        const StudyRow& row = study.rows[i];
        add(number(row.step, 6), row.mass,
            {number(row.volume_error), number(row.tensor_error), i ? order_between(study.rows[i - 1], row) : "",
             std::to_string(row.odd_rays), number(row.seconds)});
    }
    if (study.reference_is_exact) add("exact", study.reference, {});
    table.print(out);
    if (!study.reference_is_exact)
        out << "\nThe surface does not bound a volume: errors are against the finest step.\n";
    out << "\nOrder of convergence (fit): volume " << text(study.volume_order) << ", tensor "
        << text(study.tensor_order) << "\n";
}

Json to_json(const Study& study) {
    const auto tensor = [](const Mat3& m) {
        return Json{{m(0, 0), m(0, 1), m(0, 2)}, {m(1, 0), m(1, 1), m(1, 2)}, {m(2, 0), m(2, 1), m(2, 2)}};
    };
    const auto order = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    Json rows = Json::array();
    for (const StudyRow& row : study.rows)
        rows.push_back({{"step", row.step},
                        {"volume", row.mass.volume},
                        {"inertia_over_mass", tensor(row.mass.inertia_over_mass)},
                        {"volume_error", row.volume_error},
                        {"center_error", row.center_error},
                        {"tensor_error", row.tensor_error},
                        {"odd_rays", row.odd_rays},
                        {"time_s", row.seconds}});
    return {{"reference", study.reference_is_exact ? "exact" : "finest step"},
            {"volume_order", order(study.volume_order)},
            {"tensor_order", order(study.tensor_order)},
            {"rows", std::move(rows)}};
}

}  // namespace kolize::cli
