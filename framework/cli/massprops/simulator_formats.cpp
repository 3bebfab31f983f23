// Inertial elements of other simulators' model formats. All three take the entries of the tensor itself: off the
// diagonal the negative products of inertia, as in the matrix.
#include "massprops/result.h"

#include <charconv>

namespace kolize::cli {
namespace {

std::string digits(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value + 0.0).ptr};  // -0 becomes 0
}

std::string joined(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : " ") + digits(value);
    return text;
}

std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }

std::string element(const std::string& name, const std::string& value) {
    return "<" + name + ">" + value + "</" + name + ">";
}

// URDF: the frame of the inertia is given by origin; without rotation it is the link's.
std::string urdf(const Vec3& c, const Mat3& i, double mass) {
    return "<inertial>\n  <origin" + attribute("xyz", joined({c.x(), c.y(), c.z()})) + attribute("rpy", "0 0 0") +
           "/>\n  <mass" + attribute("value", digits(mass)) + "/>\n  <inertia" + attribute("ixx", digits(i(0, 0))) +
           attribute("ixy", digits(i(0, 1))) + attribute("ixz", digits(i(0, 2))) + attribute("iyy", digits(i(1, 1))) +
           attribute("iyz", digits(i(1, 2))) + attribute("izz", digits(i(2, 2))) + "/>\n</inertial>\n";
}

// MJCF: fullinertia is M(1,1) M(2,2) M(3,3) M(1,2) M(1,3) M(2,3), about pos, in the axes of the body.
std::string mjcf(const Vec3& c, const Mat3& i, double mass) {
    return "<inertial" + attribute("pos", joined({c.x(), c.y(), c.z()})) + attribute("mass", digits(mass)) +
           attribute("fullinertia", joined({i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)})) + "/>\n";
}

// SDFormat: pose is that of the inertial frame in the link's: x y z roll pitch yaw.
std::string sdf(const Vec3& c, const Mat3& i, double mass) {
    std::string text = "<inertial>\n  " + element("pose", joined({c.x(), c.y(), c.z(), 0, 0, 0})) + "\n  " +
                       element("mass", digits(mass)) + "\n  <inertia>\n";
    constexpr const char* names = "xyz";
    for (int row = 0; row < 3; ++row)
        for (int column = row; column < 3; ++column)
            text += "    " + element(std::string("i") + names[row] + names[column], digits(i(row, column))) + "\n";
    return text + "  </inertia>\n</inertial>\n";
}

}  // namespace

std::string inertial_element(const std::string& format, const MassProperties& body, double mass) {
    const Mat3 inertia = mass * body.inertia_over_mass;
    if (format == "urdf") return urdf(body.center_of_mass, inertia, mass);
    return format == "mjcf" ? mjcf(body.center_of_mass, inertia, mass) : sdf(body.center_of_mass, inertia, mass);
}

}  // namespace kolize::cli
