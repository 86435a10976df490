// SPDX-License-Identifier: MIT
// Path data to curves. Each command adds Bézier segments; a subpath becomes a curve when it ends.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/svg_path.h"

#include "circle.h"
#include "curve_distance.h"

namespace knotwave::curves {
namespace {

struct Place {
  double x = 0;
  double y = 0;
  friend bool operator==(const Place&, const Place&) = default;
};
Place mirrored(Place point, Place about) { return {2 * about.x - point.x, 2 * about.y - point.y}; }

// Of a number that no double holds: whether it is too small for one, not too large.
bool is_tiny(std::string_view number) {
  const std::size_t mark = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, mark);
  std::string_view power = number.substr(std::min(mark + 1, number.size()));
  if (power.starts_with('+')) power.remove_prefix(1);
  const std::size_t first = digits.find_first_not_of("0.");
  if (first == digits.npos) return true;
  // The first digit that is not 0 stands for about 10^(place + exponent).
  const auto place = static_cast<std::ptrdiff_t>(std::min(digits.find('.'), digits.size())) -
                     static_cast<std::ptrdiff_t>(first);
  int exponent = 0;
  const auto read = std::from_chars(power.data(), power.data() + power.size(), exponent);
  if (read.ec == std::errc::result_out_of_range) return power.starts_with('-');
  return place + exponent < 0;
}

// The words of path data: commands, numbers and flags, which need no space between them.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  bool at_end() {
    skip_space();
    return at_ == text_.size();
  }
  bool at_command() {
    return !at_end() &&
           ((text_[at_] >= 'a' && text_[at_] <= 'z') || (text_[at_] >= 'A' && text_[at_] <= 'Z'));
  }
  char command() { return text_[at_++]; }

  double number() {
    skip_separator();
    std::size_t from = at_;
    if (from < text_.size() && (text_[from] == '+' || text_[from] == '-')) ++from;
    const bool starts = from < text_.size() && (text_[from] == '.' || is_digit(text_[from]));
    double value = 0;
    const auto end = text_.data() + text_.size();
    const auto read = starts ? std::from_chars(text_.data() + from, end, value)
                             : std::from_chars_result{nullptr, std::errc::invalid_argument};
    const bool is_beyond_doubles = read.ec == std::errc::result_out_of_range;
    if (read.ec != std::errc() && !is_beyond_doubles) {
      refuse(ErrorCode::syntax, "a number is expected" + found());
      return 0;
    }
    const auto next = static_cast<std::size_t>(read.ptr - text_.data());
    if (is_beyond_doubles) value = is_tiny(text_.substr(from, next - from)) ? 0 : HUGE_VAL;
    if (text_[at_] == '-') value = -value;
    if (std::abs(value) > kMaxCoordinate) refuse_size(value, text_.substr(at_, next - at_));
    at_ = next;
    argument_ = true;
    return value;
  }
  bool flag() {
    skip_separator();
    if (at_ == text_.size() || (text_[at_] != '0' && text_[at_] != '1')) {
      refuse(ErrorCode::syntax, "a flag, 0 or 1, is expected" + found());
      return false;
    }
    return text_[at_++] == '1';
  }

  /// Commas stand between numbers, not before the first one of a command.
  void begin_arguments(bool repeated) { argument_ = repeated; }

  void refuse(ErrorCode code, const std::string& message) {
    if (fault_) return;
    fault_ = fail(code, "path data: " + message);
    fault_->offset = static_cast<long long>(at_);
  }
  std::string found() const {
    return at_ == text_.size() ? ", found the end" : ", found '" + std::string(1, text_[at_]) + "'";
  }
  const std::optional<Error>& fault() const { return fault_; }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  void refuse_size(double value, std::string_view as_written) {
    constexpr std::size_t kMost = 24;  // characters to show
    const bool is_long = as_written.size() > kMost;
    const std::string number =
        std::isfinite(value) ? base::number_text(value)
                             : std::string(as_written.substr(0, kMost)) + (is_long ? "..." : "");
    refuse(ErrorCode::coordinate_out_of_range,
           number + " is beyond " + base::number_text(kMaxCoordinate));
  }
  void skip_space() {
    constexpr std::string_view kSpace = " \t\n\f\r";
    while (at_ < text_.size() && kSpace.find(text_[at_]) != kSpace.npos) ++at_;
  }
  void skip_separator() {
    skip_space();
    if (argument_ && at_ < text_.size() && text_[at_] == ',') ++at_;
    skip_space();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool argument_ = false;
  std::optional<Error> fault_;
};

// From the unit circle about (0, 0) onto the page.
struct EllipseFrame {
  DoubleDouble centre_x, centre_y, radius_x, radius_y;
  UnitVector axis;

  Place place(DoubleDouble x, DoubleDouble y) const {
    const DoubleDouble a = radius_x * x, b = radius_y * y;
    return {(centre_x + axis.x * a - axis.y * b).hi, (centre_y + axis.y * a + axis.x * b).hi};
  }
};

class PathReader {
 public:
  PathReader(std::string_view d, SvgY y) : words_(d), y_(y) {}
  Result<std::vector<NurbsCurve>> read();

 private:
  void carry_out(char command);
  void draw(char kind);
  Place point();
  void add(std::vector<Place> points);
  void add_arc(double radius_x, double radius_y, double turn_deg, bool large, bool sweep, Place to);
  void add_quarters(UnitVector from, UnitVector to, bool sweep, int halvings,
                    const EllipseFrame& frame, Place end);
  void close();
  void end_subpath();

  Words words_;
  SvgY y_;
  bool relative_ = false;
  Place now_, start_;
  std::optional<Place> cubic_handle_, quadratic_handle_;  // of the command before
  std::vector<BezierSegment> segments_;
  std::vector<NurbsCurve> curves_;
  std::optional<Error> fault_;
};

Place PathReader::point() {
  const double x = words_.number(), y = words_.number();
  return relative_ ? Place{now_.x + x, now_.y + y} : Place{x, y};
}

void PathReader::add(std::vector<Place> points) {
  const double u = static_cast<double>(segments_.size());
  BezierSegment segment{u, u + 1, static_cast<int>(points.size()), 2, {now_.x, now_.y}, {1}};
  for (const Place& place : points) {
    segment.points.insert(segment.points.end(), {place.x, place.y});
    segment.weights.push_back(1);
  }
  segments_.push_back(std::move(segment));
  now_ = points.back();
}

void PathReader::add_quarters(UnitVector from, UnitVector to, bool sweep, int halvings,
                              const EllipseFrame& frame, Place end) {
  if (halvings > 0) {
    const UnitVector middle = half_way(from, to, sweep);
    add_quarters(from, middle, sweep, halvings - 1, frame, frame.place(middle.x, middle.y));
    add_quarters(middle, to, sweep, halvings - 1, frame, end);
    return;
  }
  const ArcMiddle middle = arc_middle(from, to);
  add({frame.place(middle.x, middle.y), end});
  segments_.back().weights[1] = middle.weight.hi;
}

// B.2.4 and B.2.5, without an angle but that of the axis.
void PathReader::add_arc(double radius_x, double radius_y, double turn_deg, bool large, bool sweep,
                         Place to) {
  constexpr double kSmallest = 1e-9;  // radii and distances below count as 0
  if (to == now_) return;
  const double dx = (now_.x - to.x) / 2, dy = (now_.y - to.y) / 2;
  radius_x = std::abs(radius_x);
  radius_y = std::abs(radius_y);
  if (std::min(radius_x, radius_y) < kSmallest ||
      std::max(std::abs(dx), std::abs(dy)) < kSmallest) {
    add({to});
    return;
  }
  EllipseFrame frame{0.0, 0.0, radius_x, radius_y, direction_at(turn_deg / 360)};
  // Half the chord on the unit circle.
  DoubleDouble x =
      (frame.axis.x * DoubleDouble(dx) + frame.axis.y * DoubleDouble(dy)) / DoubleDouble(radius_x);
  DoubleDouble y =
      (frame.axis.x * DoubleDouble(dy) - frame.axis.y * DoubleDouble(dx)) / DoubleDouble(radius_y);
  const DoubleDouble square = x * x + y * y;
  DoubleDouble centre_x = 0.0, centre_y = 0.0;
  const bool half_circle = square.hi >= 1;
  if (half_circle) {
    const DoubleDouble scale = square_root(square);
    frame.radius_x = frame.radius_x * scale;
    frame.radius_y = frame.radius_y * scale;
    x = x / scale;
    y = y / scale;
  } else {
    const DoubleDouble off = square_root((DoubleDouble(1.0) - square) / square);
    centre_x = large != sweep ? off * y : -(off * y);
    centre_y = large != sweep ? -(off * x) : off * x;
  }
  const Place centre = frame.place(centre_x, centre_y);  // from the middle of the chord
  frame.centre_x = DoubleDouble(centre.x) + DoubleDouble::sum(now_.x, to.x) / DoubleDouble(2.0);
  frame.centre_y = DoubleDouble(centre.y) + DoubleDouble::sum(now_.y, to.y) / DoubleDouble(2.0);
  const UnitVector from = direction_of(x - centre_x, y - centre_y);
  const UnitVector until = direction_of(-x - centre_x, -y - centre_y);
  const bool obtuse = (from.x * until.x + from.y * until.y).hi < 0;
  const int halvings = large && !half_circle ? 2 : obtuse ? 1 : 0;
  add_quarters(from, until, sweep, halvings, frame, to);
}

void PathReader::close() {
  if (now_ != start_) add({start_});
  end_subpath();
  now_ = start_;
}

void PathReader::end_subpath() {
  if (segments_.empty() || fault_) return;
  int degree = 1;
  for (const BezierSegment& segment : segments_) degree = std::max(degree, segment.degree);
  for (BezierSegment& segment : segments_) {
    std::vector<HomogeneousPoint> points;
    for (std::size_t i = 0; i < segment.weights.size(); ++i) {
      points.emplace_back(std::span(segment.points).subspan(2 * i, 2), segment.weights[i]);
    }
    while (segment.degree < degree) {
      raise_degree(points);
      ++segment.degree;
    }
    segment.points.resize(2 * points.size());
    segment.weights.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto place = std::span(segment.points).subspan(2 * i, 2);
      points[i].project(place);
      if (y_ == SvgY::up) place[1] = 0.0 - place[1];
      segment.weights[i] = points[i].w.hi;
    }
  }
  auto curve = from_bezier(segments_);
  segments_.clear();
  if (!curve) {
    fault_ = std::move(curve).error();
    return;
  }
  CurveSpec spec = curve->spec();
  spec.name = "path_" + std::to_string(curves_.size() + 1);
  curves_.push_back(*NurbsCurve::create(std::move(spec)));
}

// One set of arguments of a command that draws, `kind` in capitals.
void PathReader::draw(char kind) {
  std::optional<Place> cubic, quadratic;
  const auto along = [&](double origin) { return words_.number() + (relative_ ? origin : 0); };
  if (kind == 'L') {
    add({point()});
  } else if (kind == 'H') {
    add({{along(now_.x), now_.y}});
  } else if (kind == 'V') {
    add({{now_.x, along(now_.y)}});
  } else if (kind == 'C' || kind == 'S') {
    const Place first = kind == 'C' ? point() : mirrored(cubic_handle_.value_or(now_), now_);
    cubic = point();
    const Place to = point();
    add({first, *cubic, to});
  } else if (kind == 'Q' || kind == 'T') {
    quadratic = kind == 'Q' ? point() : mirrored(quadratic_handle_.value_or(now_), now_);
    add({*quadratic, point()});
  } else {
    const double radius_x = words_.number(), radius_y = words_.number();
    const double turn_deg = words_.number();
    const bool large = words_.flag(), sweep = words_.flag();
    const Place to = point();
    if (!words_.fault()) add_arc(radius_x, radius_y, turn_deg, large, sweep, to);
  }
  cubic_handle_ = cubic;
  quadratic_handle_ = quadratic;
}

// A command with all sets of its arguments.
void PathReader::carry_out(char command) {
  relative_ = command >= 'a';
  char kind = relative_ ? static_cast<char>(command - 'a' + 'A') : command;
  if (kind == 'Z') {
    close();
    cubic_handle_ = quadratic_handle_ = std::nullopt;
    return;
  }
  if (std::string_view("MLHVCSQTA").find(kind) == std::string_view::npos) {
    words_.refuse(ErrorCode::syntax, std::string("'") + command + "' is no command of path data");
    return;
  }
  words_.begin_arguments(false);
  if (kind == 'M') {
    end_subpath();
    start_ = now_ = point();
    cubic_handle_ = quadratic_handle_ = std::nullopt;
    kind = 'L';
    if (words_.at_end() || words_.at_command()) return;
    words_.begin_arguments(true);
  }
  do {
    draw(kind);
    words_.begin_arguments(true);
  } while (!words_.fault() && !words_.at_end() && !words_.at_command());
}

Result<std::vector<NurbsCurve>> PathReader::read() {
  bool first = true;
  while (!words_.at_end() && !words_.fault() && !fault_) {
    if (!words_.at_command()) {
      words_.refuse(ErrorCode::syntax, "a command is expected" + words_.found());
      break;
    }
    const std::string found = words_.found();
    const char command = words_.command();
    if (first && command != 'M' && command != 'm') {
      words_.refuse(ErrorCode::syntax, "it must begin with M or m" + found);
      break;
    }
    first = false;
    carry_out(command);
  }
  if (!words_.fault()) end_subpath();
  if (words_.fault()) return *words_.fault();
  if (fault_) return *fault_;
  if (curves_.empty()) return fail(ErrorCode::too_few_points, "path data: nothing is drawn");
  return std::move(curves_);
}

}  // namespace

Result<std::vector<NurbsCurve>> curves_from_svg_path(std::string_view d, SvgY y) {
  return PathReader(d, y).read();
}

Result<NurbsCurve> in_unit_square(const NurbsCurve& curve) {
  CurveSpec spec = curve.spec();
  const auto dim = static_cast<std::size_t>(spec.dim);
  for (std::size_t c = 0; c < dim; ++c) {
    const ValueRange range = value_range(curve, static_cast<int>(c));
    const double low = range.low.value, width = range.high.value - low;
    for (std::size_t i = c; i < spec.points.size(); i += dim) {
      spec.points[i] = width > 0 ? (spec.points[i] - low) / width : 0;
    }
  }
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves
