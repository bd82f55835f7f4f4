// Plane curve of lines and arcs, the solid on the left of the walk along it: exact signed distance.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

using Vec2 = Vec<double, 2>;

/// Signed distance in the plane: g < 0 in the solid, unit normal n out of it, Hessian k t t^T with t across n.
struct PlaneGap {
    double g;
    Vec2 n;
    double k;
};

/// A line (turn 0), or an arc about `centre` that turns left (1, convex) or right (-1, concave). An arc that ends where it
/// starts is the whole circle.
struct Segment {
    Vec2 start, end, centre;
    int turn;
};

/// Type of the first and the last segment: they meet, extend to infinity, or end on an axis of revolution x = 0.
enum class ProfileEnd { Joined, Endless, OnAxis };

inline Vec2 minus(const Vec2& a, const Vec2& b) { return {a[0] - b[0], a[1] - b[1]}; }
inline Vec2 scaled(double s, const Vec2& a) { return {s * a[0], s * a[1]}; }
/// Turned clockwise by a right angle: from the tangent of a profile to its normal.
inline Vec2 right_of(const Vec2& t) { return {t[1], -t[0]}; }
inline Vec2 unit(const Vec2& a) { return scaled(1.0 / std::sqrt(dot(a, a)), a); }

class Profile {
  public:
    /// Segments in the order of the walk, each starting where the one before has ended.
    Profile(const std::vector<Segment>& segments, ProfileEnd start, ProfileEnd end) {
        for (const Segment& segment : segments) {
            pieces_.push_back(piece(segment));
            for (const Vec2& point : {segment.start, segment.end})
                size_ = std::max({size_, std::abs(point[0]), std::abs(point[1])});
        }
        const std::size_t last = segments.size() - 1;
        for (std::size_t i = 0; i <= last; ++i) {
            const std::size_t next = i == last ? 0 : i + 1;
            if (i == last && end != ProfileEnd::Joined) break;
            const Segment &one = segments[i], &other = segments[next];
            pieces_[i].last = pieces_[next].first = corner(other.start, tangent(one, one.end), curvature(one),
                                                           tangent(other, other.start), curvature(other));
        }
        finish(segments.front(), start, pieces_.front().first, pieces_.front().from, -1.0);
        finish(segments.back(), end, pieces_.back().last, pieces_.back().to, 1.0);
    }

    /// Largest coordinate of its points.
    double size() const { return size_; }

    /// The nearest of all segments decides, the first of equals. eqs. (4.21)-(4.23)
    PlaneGap gap(const Vec2& x) const {
        const Piece* nearest = pieces_.data();
        double least = std::numeric_limits<double>::infinity();
        for (const Piece& piece : pieces_) {
            const double square = piece.turn == 0 ? square_to_line(piece, x) : square_to_arc(piece, x);
            if (square < least) least = square, nearest = &piece;
        }
        return nearest->turn == 0 ? from_line(*nearest, x) : from_arc(*nearest, x);
    }

  private:
    /// An end of a segment: tangents and curvatures before and behind it, the mean normal, and whether there is a kink.
    struct Corner {
        Vec2 at{}, before{}, after{}, n{};
        double k_before = 0.0, k_after = 0.0;
        bool sharp = false;
    };

    struct Piece {
        int turn;         // 0: a line
        Vec2 base;        // start of the line, centre of the arc
        Vec2 along;       // unit tangent of the line; unit vector from the centre to the middle of the arc
        double from, to;  // coordinates of the ends along the line
        double radius;    // of the arc
        double cosine;    // of half the angle of the arc
        Corner first, last;
    };

    static Piece piece(const Segment& s) {
        const Vec2 chord = minus(s.end, s.start);
        const double length = std::sqrt(dot(chord, chord));
        if (s.turn == 0) return {0, s.start, unit(chord), 0.0, length, 0.0, 0.0, {}, {}};
        const Vec2 p = minus(s.start, s.centre), q = minus(s.end, s.centre);
        const double radius = 0.5 * (std::sqrt(dot(p, p)) + std::sqrt(dot(q, q)));
        if (length == 0.0)
            return {s.turn, s.centre, unit(p), 0.0, 0.0, radius, -2.0, {}, {}};  // no direction is outside
        const Vec2 middle = scaled(s.turn / length, right_of(chord));  // the arc bulges to this side of its chord
        return {s.turn, s.centre, middle, 0.0, 0.0, radius, dot(p, middle) / radius, {}, {}};
    }

    static Vec2 tangent(const Segment& s, const Vec2& at) {
        return s.turn == 0 ? unit(minus(s.end, s.start)) : unit(scaled(-s.turn, right_of(minus(at, s.centre))));
    }

    static double curvature(const Segment& s) {
        const Vec2 p = minus(s.start, s.centre);
        return s.turn == 0 ? 0.0 : s.turn / std::sqrt(dot(p, p));
    }

    /// Below a turn of 1e-7 the distances to the corner and to its two segments differ by round-off only: no kink.
    static Corner corner(const Vec2& at, const Vec2& before, double k_before, const Vec2& after, double k_after) {
        const double sine = before[0] * after[1] - before[1] * after[0];
        const Vec2 n = unit({before[1] + after[1], -before[0] - after[0]});
        return {at, before, after, n, k_before, k_after, std::abs(sine) > 1e-7 || dot(before, after) < 0.0};
    }

    /// An end on the axis meets its own mirror image there.
    static void finish(const Segment& s, ProfileEnd kind, Corner& end, double& range, double sign) {
        if (kind == ProfileEnd::Endless) range = sign * std::numeric_limits<double>::infinity();
        if (kind != ProfileEnd::OnAxis) return;
        const Vec2 at = sign < 0.0 ? s.start : s.end, t = tangent(s, at), image{t[0], -t[1]};
        const double k = curvature(s);
        end = sign < 0.0 ? corner(at, image, k, t, k) : corner(at, t, k, image, k);
    }

    /// An end counts a little farther than it is: of equals to round-off the one inside of a segment is taken.
    static constexpr double end_is_farther = 1.0 + 1e-12;

    static double square_to_line(const Piece& line, const Vec2& x) {
        const Vec2 d = minus(x, line.base);
        const double along = dot(d, line.along), across = dot(d, right_of(line.along));
        const double beyond = std::max({line.from - along, along - line.to, 0.0});
        return (across * across + beyond * beyond) * (beyond > 0.0 ? end_is_farther : 1.0);
    }

    static double square_to_arc(const Piece& arc, const Vec2& x) {
        const Vec2 p = minus(x, arc.base), a = minus(x, arc.first.at), b = minus(x, arc.last.at);
        const double rho = std::sqrt(dot(p, p)), depth = rho - arc.radius;
        return meets(arc, p, rho) ? depth * depth : std::min(dot(a, a), dot(b, b)) * end_is_farther;
    }

    /// Whether the ray from the centre of an arc along p meets it.
    static bool meets(const Piece& arc, const Vec2& p, double rho) {
        return dot(p, arc.along) > rho * arc.cosine || rho == 0.0;
    }

    static PlaneGap from_line(const Piece& line, const Vec2& x) {
        const Vec2 d = minus(x, line.base), n = right_of(line.along);
        const double along = dot(d, line.along);
        if (along <= line.from) return from_end(line.first, x);
        if (along >= line.to) return from_end(line.last, x);
        return {dot(d, n), n, 0.0};
    }

    static PlaneGap from_arc(const Piece& arc, const Vec2& x) {
        const Vec2 p = minus(x, arc.base), a = minus(x, arc.first.at), b = minus(x, arc.last.at);
        if (!meets(arc, p, std::sqrt(dot(p, p)))) return from_end(dot(a, a) <= dot(b, b) ? arc.first : arc.last, x);
        return from_point(arc.base, arc.turn, scaled(arc.turn, arc.along), arc.radius, x);
    }

    /// Seen from the corner itself, which is exact: beside it the tangents, between its two normals the corner.
    static PlaneGap from_end(const Corner& end, const Vec2& x) {
        const Vec2 p = minus(x, end.at);
        if (dot(p, end.before) < 0.0) return from_tangent(right_of(end.before), end.k_before, p);
        if (dot(p, end.after) > 0.0) return from_tangent(right_of(end.after), end.k_after, p);
        if (!end.sharp) return from_tangent(end.n, end.k_after, p);
        return from_point(end.at, dot(p, end.n) < 0.0 ? -1 : 1, end.n, 0.0, x);
    }

    /// Nearest to an end by round-off only: the tangent takes the place of the segment.
    static PlaneGap from_tangent(const Vec2& n, double k, const Vec2& p) {
        const double g = dot(p, n), stretch = 1.0 + g * k;  // 0 at the centre of the arc
        return {g, n, stretch > 1e-12 ? k / stretch : 0.0};
    }

    /// Distance to a circle about a point, its inside solid (side 1) or void (-1); at the very point n is `otherwise`.
    static PlaneGap from_point(const Vec2& centre, int side, const Vec2& otherwise, double radius, const Vec2& x) {
        const Vec2 p = minus(x, centre);
        const double rho = std::sqrt(dot(p, p));
        if (rho == 0.0) return {-side * radius, otherwise, 0.0};
        return {side * (rho - radius), scaled(side / rho, p), side / rho};
    }

    std::vector<Piece> pieces_;
    double size_ = 0.0;
};

}  // namespace umform
