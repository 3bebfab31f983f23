#include "massprops/study.h"

#include <algorithm>
#include <sstream>

namespace kolize::cli {
namespace {

constexpr double width = 720, height = 480, left = 80, right = 24, top = 48, bottom = 56;

// Decades onto pixels.
struct LogAxis {
    double low, high;   // log10, whole numbers
    double begin, end;  // pixels
    double at(double value) const { return begin + (std::log10(value) - low) / (high - low) * (end - begin); }
};

LogAxis axis_over(const std::vector<double>& values, double begin, double end) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double low = std::floor(std::log10(*least)), high = std::ceil(std::log10(*most));
    return {low, high > low ? high : low + 1, begin, end};
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

class Plot {
public:
    Plot(const LogAxis& x, const LogAxis& y) : x_(x), y_(y) {
        out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\"" << height
             << "\" viewBox=\"0 0 " << width << ' ' << height
             << "\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
                "fill=\"white\"/>\n";
        for (double decade = x.low; decade <= x.high; ++decade) grid_line(decade, true);
        for (double decade = y.low; decade <= y.high; ++decade) grid_line(decade, false);
    }

    void text(double x, double y, const std::string& content, const std::string& more = "") {
        out_ << "<text x=\"" << x << "\" y=\"" << y << "\"" << more << ">" << escaped(content) << "</text>\n";
    }

    // Values that a logarithmic axis cannot show are left out.
    void series(const std::vector<std::pair<double, double>>& points, const std::string& colour,
                const std::string& name) {
        out_ << "<polyline fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"2\" points=\"";
        for (const auto& [x, y] : points) out_ << x_.at(x) << ',' << y_.at(y) << ' ';
        out_ << "\"/>\n";
        for (const auto& [x, y] : points)
            out_ << "<circle cx=\"" << x_.at(x) << "\" cy=\"" << y_.at(y) << "\" r=\"3.5\" fill=\"" << colour
                 << "\"/>\n";
        text(left + 12, top + 20 + 18 * series_++, name, " fill=\"" + colour + "\"");
    }

    void guide(double x0, double y0, double x1, double y1) {
        out_ << "<line x1=\"" << x_.at(x0) << "\" y1=\"" << y_.at(y0) << "\" x2=\"" << x_.at(x1) << "\" y2=\""
             << y_.at(y1) << "\" stroke=\"gray\" stroke-dasharray=\"5 4\"/>\n";
    }

    std::string finish() {
        out_ << "</svg>\n";
        return out_.str();
    }

private:
    void grid_line(double decade, bool vertical) {
        const double at = vertical ? x_.at(std::pow(10, decade)) : y_.at(std::pow(10, decade));
        const double x1 = vertical ? at : left, x2 = vertical ? at : width - right;
        const double y1 = vertical ? top : at, y2 = vertical ? height - bottom : at;
        out_ << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
             << "\" stroke=\"#ddd\"/>\n";
        const std::string label = number(std::pow(10, decade));
        if (vertical)
            text(at, height - bottom + 20, label, " text-anchor=\"middle\"");
        else
            text(left - 8, at + 4, label, " text-anchor=\"end\"");
    }

    LogAxis x_, y_;
    std::ostringstream out_;
    int series_ = 0;
};

std::vector<std::pair<double, double>> points_of(const Study& study, double StudyRow::*error) {
    std::vector<std::pair<double, double>> points;
    for (const StudyRow& row : study.rows)
        if (row.*error > 0) points.emplace_back(row.step, row.*error);
    return points;
}

}  // namespace

std::string plot_svg(const Study& study, const std::string& title) {
    const auto volume = points_of(study, &StudyRow::volume_error), tensor = points_of(study, &StudyRow::tensor_error);
    std::vector<double> steps, errors;
    for (const StudyRow& row : study.rows) steps.push_back(row.step);
    for (const auto* points : {&volume, &tensor})
        for (const auto& point : *points) errors.push_back(point.second);
    if (errors.empty()) errors = {1e-16};
    Plot plot(axis_over(steps, left, width - right), axis_over(errors, height - bottom, top));
    plot.text(left, 28, title, " font-size=\"16\"");
    plot.text(width / 2, height - 12, "step (model units)", " text-anchor=\"middle\"");
    plot.text(20, height / 2, "relative error",
              " text-anchor=\"middle\" transform=\"rotate(-90 20 " + number(height / 2) + ")\"");
    plot.series(volume, "#1f77b4", "volume");
    plot.series(tensor, "#d62728", "inertia tensor");
    if (tensor.size() > 1) {  // from the coarsest point down
        const auto& [step, error] = tensor.front();
        const double end = tensor.back().first;
        plot.guide(step, error, end, error * (end / step) * (end / step));
        plot.text(left + 12, top + 56, "dashed: second order", " fill=\"gray\"");
    }
    return plot.finish();
}

}  // namespace kolize::cli
