#include "massprops/prompt.h"

#include <kolize/error.h>

#include <charconv>
#include <filesystem>

namespace kolize::cli {
namespace {

// Asks until `accept` takes the answer; it returns what is wrong with it, or nothing.
template <class Accept>
void ask(const std::string& question, std::istream& in, std::ostream& out, const Accept& accept) {
    for (std::string answer; out << question << " " << std::flush, std::getline(in, answer);) {
        const std::string complaint = accept(answer);
        if (complaint.empty()) return;
        out << "  " << complaint << "\n";
    }
    throw Error("the input ended before all was answered (file, step, axes)");
}

template <class Number>
bool read_number(const std::string& text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

void ask_for(MassPropsOptions& options, std::istream& in, std::ostream& out) {
    ask("Model (OBJ, OFF, PLY, STL or WRL file):", in, out, [&](const std::string& answer) -> std::string {
        options.model = answer;
        return std::filesystem::is_regular_file(answer) ? "" : "'" + answer + "' is not a file";
    });
    ask("Step (> 0: spacing of the rays; < 0: divisions of the longest side; empty: no rays, exact integrals):", in,
        out, [&](const std::string& answer) -> std::string {
            if (answer.empty()) return "";
            double step = 0;
            if (!read_number(answer, step) || step == 0) return "'" + answer + "' is not a number other than 0";
            options.step = step;
            return "";
        });
    if (!options.step) return;
    ask("Axes along which rays go, 1 to 3 (empty: 3):", in, out, [&](const std::string& answer) -> std::string {
        int axes = 3;
        if (!answer.empty() && (!read_number(answer, axes) || axes < 1 || axes > 3)) return "1, 2 or 3 is wanted";
        options.voxel.axes = axes;
        return "";
    });
}

}  // namespace kolize::cli
