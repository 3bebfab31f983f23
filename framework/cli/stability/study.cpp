#include "stability/study.h"

namespace kolize::cli::stability {

const char* word(Failure failure) {
    switch (failure) {
    case Failure::none: return "holds";
    case Failure::wrong: return "wrong";
    case Failure::missed: return "missed";
    case Failure::late: return "late";
    case Failure::inaccurate: return "inaccurate";
    case Failure::not_finite: return "not finite";
    case Failure::hang: return "hangs";
    case Failure::escaped: return "escaped";
    case Failure::stuck: return "stuck";
    case Failure::refused: return "refuses";
    }
    return "";
}

std::string magnitude(double decades) { return number(std::pow(10.0, decades), 2); }

Point Study::usual() const {
    Point point;
    for (const Axis& axis : axes) point.push_back(axis.usual);
    return point;
}

Outcome ask(const Study& study, const Subject& subject, const Point& point) {
    try {
        return study.probe(subject, point);
    } catch (const Hang& hang) {
        return {Failure::hang, hang.what()};
    } catch (const std::bad_alloc&) {
        return {Failure::hang, "it runs out of memory"};
    } catch (const std::exception& error) {
        return {Failure::refused, error.what()};
    }
}

}  // namespace kolize::cli::stability
