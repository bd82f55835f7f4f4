// Smooth surface through the corners of triangles: signed distance to quartic patches with common tangent planes.
#pragma once

#include "umform/surfaces/box_tree.hpp"
#include "umform/surfaces/concept.hpp"
#include "umform/surfaces/patch_foot.hpp"

namespace umform {

/// The surface across the edge of a triangle: it has one tangent plane, a sharp edge, or a rim.
enum class Across : std::uint8_t { Smooth, Sharp, Rim };

/// A third of a triangle: the edge a b lies on that of the triangle, c inside of it.
struct Third {
    QuarticPatch patch;
    Across across;
    int neighbour;            // the third on the other side of a b, -1 at a rim
    std::array<int, 2> ends;  // corners a and b of the triangulation
    int face;                 // the exact surface that the patch stands for, -1 for none
};

/// Surfaces that patches stand for. They count where their distance differs from that to the patch by no more than `trust`.
struct ExactFaces {
    std::vector<std::shared_ptr<const Surface>> surfaces;
    double trust = 0.0;
};

/// A corner of the triangulation: the sum of the normals around it, and the sharpest that meets there.
struct Corner {
    Vec3 normal;
    Across across;
};

class Triangulated final : public Surface {
  public:
    Triangulated(const std::vector<Third>& thirds, std::vector<Corner> corners, ExactFaces exact)
        : tree_(boxes(thirds)), corners_(std::move(corners)), exact_(std::move(exact)) {
        const std::vector<int>& order = tree_.order();
        std::vector<int> place(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
        for (const int i : order) {
            thirds_.push_back(thirds[i]);
            flats_.push_back(Flat(thirds[i].patch));
            int& neighbour = thirds_.back().neighbour;
            if (neighbour >= 0) neighbour = place[neighbour];
        }
    }

    bool is_distance() const override { return true; }
    bool is_concurrent() const override { return true; }

    bool searches() const override { return true; }

    /// The patch of the point before bounds the distance of the next one; it changes the way of the search only.
    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        int last = 0;
        for (int q = 0; q < count; ++q) {
            const Vec3 at{x[3 * q], x[3 * q + 1], x[3 * q + 2]};
            const Found found = nearest(at, last);
            last = found.third;
            put(gap_at(at, found), q, g, n, H);
        }
    }
    void gap_again(int count, const double* x, Nearby* nearby, double* g, double* n, double* H) const override {
        int last = 0;
        for (int q = 0; q < count; ++q) {
            if (q + 1 < count && nearby[q + 1].count > 0) {
                prefetch(flats_[nearby[q + 1].part[0]]);
                prefetch(thirds_[nearby[q + 1].part[0]].patch);
            }
            const Vec3 at{x[3 * q], x[3 * q + 1], x[3 * q + 2]};
            const Found found = nearest(at, nearby[q], last);
            last = found.third;
            put(gap_at(at, found), q, g, n, H);
        }
    }

  private:
    /// The flat triangle of the corners of a patch, apart from it: the search reads many of these and few patches.
    struct Flat {
        Vec3 a, b, c;
        double bulge;  // no point of the patch is farther from the triangle: the distance to a convex set is convex
        double lift;   // no point of the patch is farther from the point of the triangle with the same parameters

        explicit Flat(const QuarticPatch& patch)
            : a(patch.control[QuarticPatch::a]), b(patch.control[QuarticPatch::b]), c(patch.control[QuarticPatch::c]) {
            double out = 0.0, off = 0.0;
            for (int row = 0, k = 0; row < 5; ++row)
                for (int i = 0; i < 5 - row; ++i, ++k) {
                    const Vec3& x = patch.control[k];
                    Vec3 d;
                    for (int j = 0; j < 3; ++j) d[j] = x[j] - 0.25 * ((4 - row - i) * a[j] + i * b[j] + row * c[j]);
                    out = std::max(out, foot(x).square), off = std::max(off, dot(d, d));
                }
            bulge = std::sqrt(out) * (1.0 + 1e-12), lift = std::sqrt(off) * (1.0 + 1e-12);
        }
        /// Not inlined: wherever it is called from it has the same bits.
        [[gnu::noinline]] FlatFoot foot(const Vec3& x) const { return foot_on_triangle(x, a, b, c); }
    };

    struct Found {
        int third;
        PatchFoot foot;
    };

    /// What the flat triangle of a third says: the least distance that its patch may have, and where to look for its foot.
    struct Candidate {
        int third;
        double least;
        PatchParameter start;
    };

    /// First the flat triangles, whose distances bound those of their patches from both sides, then the few patches that may
    /// be nearest. Of equally near ones the first counts, so that the answer does not depend on where the search began.
    /// eq. (4.170)
    class Search {
      public:
        Search(const Triangulated& tool, const Vec3& x) : tool_(tool), x_(x) {
            best_.foot.square = std::numeric_limits<double>::infinity();
        }

        /// No patch that has not been looked at counts if it is farther than this.
        double bound() const { return bound_; }

        /// The least distance that the patch of a third may have.
        double look_at(int i) {
            const Flat& flat = tool_.flats_[i];
            const FlatFoot foot = flat.foot(x_);
            const double distance = std::sqrt(foot.square), least = distance * (1.0 - 1e-12) - flat.bulge;
            if (least > bound_) return least;
            if (count_ == candidates_.size()) settle();
            candidates_[count_++] = {i, least, foot.p};
            prefetch(tool_.thirds_[i].patch);
            bound_ = std::min(bound_, (distance + flat.lift) * (1.0 + 1e-9));
            return least;
        }

        const Found& found() {
            settle();
            return best_;
        }

      private:
        /// Feet on the candidates, those that may lie nearest first.
        void settle() {
            while (count_ > 0) {
                const auto next =
                    std::min_element(candidates_.begin(), candidates_.begin() + count_,
                                     [](const Candidate& a, const Candidate& b) { return a.least < b.least; });
                const Candidate candidate = *next;
                *next = candidates_[--count_];
                if (candidate.least > bound_) continue;
                const PatchFoot foot = tool_.foot_on(candidate, x_);
                const double best = best_.foot.square;
                if (foot.square < best || (foot.square == best && candidate.third < best_.third))
                    best_ = {candidate.third, foot};
                bound_ = std::min(bound_, std::sqrt(best_.foot.square) * (1.0 + 1e-12));
            }
        }

        const Triangulated& tool_;
        Vec3 x_;
        std::array<Candidate, 64> candidates_;
        std::size_t count_ = 0;
        double bound_ = std::numeric_limits<double>::infinity();
        Found best_{0, {}};
    };

    [[gnu::noinline]] PatchFoot foot_on(const Candidate& candidate, const Vec3& x) const {
        return FootSearch(thirds_[candidate.third].patch, x).from(candidate.start);
    }

    Found nearest(const Vec3& x, int last) const {
        Search search(*this, x);
        search.look_at(last);
        tree_.near_first(
            x, search.bound() * search.bound(),
            [&](int i) {
                if (i != last) search.look_at(i);
                return search.bound() * search.bound();
            },
            [&](int i) { prefetch(flats_[i]); });
        return search.found();
    }

    /// The nearest one of the parts that are known, if no other part can be as near. Else that of a search: for all parts
    /// around if the point is no farther from the tool than a triangle is long, which contact asks for again.
    Found nearest(const Vec3& x, Nearby& nearby, int last) const {
        if (nearby.count == 0) {
            const Found found = nearest(x, last);
            if (is_close(found)) nearby.clear(x), nearby.add(found.third, 0.0), nearby.others = 0.0;
            return found;
        }
        const Vec3 d = difference(x, nearby.place);
        const double way = std::sqrt(dot(d, d)) * (1.0 + 1e-12);
        Search search(*this, x);
        for (int k = 0; k < nearby.count && nearby.least[k] - way <= search.bound(); ++k)
            search.look_at(nearby.part[k]);
        if (search.bound() < nearby.others - way) return search.found();
        const Found found = look_around(x, nearby, nearby);
        if (!is_close(found)) nearby.count = 0;
        return found;
    }

    bool is_close(const Found& found) const {
        const Vec3 ab = difference(flats_[found.third].b, flats_[found.third].a);
        return found.foot.square < dot(ab, ab);
    }

    /// Searches from some known parts on for all that the next search may need.
    Found look_around(const Vec3& x, Nearby& nearby, const Nearby start) const {
        Search search(*this, x);
        nearby.clear(x);
        for (int k = 0; k < start.count; ++k) nearby.add(start.part[k], search.look_at(start.part[k]));
        const auto square = [&] {
            const double farthest = std::max(search.bound(), nearby.others);
            return farthest * farthest;
        };
        tree_.near_first(
            x, square(),
            [&](int i) {
                if (!start.has(i)) nearby.add(i, search.look_at(i));
                return square();
            },
            [&](int i) { prefetch(flats_[i]); });
        return search.found();
    }

    [[gnu::noinline]] Gap gap_at(const Vec3& x, const Found& found) const {
        const Third& third = thirds_[found.third];
        const auto& [u, v] = found.foot.p;
        const Vec3 r = difference(x, found.foot.at.S);
        if (v == 0.0 && (u == 0.0 || u == 1.0)) {
            const Corner& corner = corners_[third.ends[u == 1.0 ? 1 : 0]];
            if (corner.across != Across::Smooth) return from_corner(r, corner.normal, corner.across);
        } else if (v == 0.0 && third.across != Across::Smooth) {
            return from_edge(r, found);
        }
        const Gap smooth = from_face(r, found.foot.at);
        return third.face < 0 ? smooth : exact(x, *exact_.surfaces[third.face], smooth);
    }

    /// The exact surface extends beyond its face: it is used where the patch agrees. eq. (4.173)
    Gap exact(const Vec3& x, const Surface& surface, const Gap& smooth) const {
        Gap gap;
        surface.gap(1, x.data(), &gap.g, gap.n.data(), gap.H.a.data());
        return std::abs(gap.g - smooth.g) <= exact_.trust && dot(gap.n, smooth.n) > 0.9 ? gap : smooth;
    }

    /// g = (x - y) . n, H = - a_d a^dc b_ca M^ab a_b with M = a - g b. eq. (4.167)
    static Gap from_face(const Vec3& r, const PatchPoint& at) {
        const Vec3 n = normalised(cross(at.Su, at.Sv));
        Gap gap{dot(r, n), n, {}};
        const double auu = dot(at.Su, at.Su), auv = dot(at.Su, at.Sv), avv = dot(at.Sv, at.Sv);
        const double buu = dot(n, at.Suu), buv = dot(n, at.Suv), bvv = dot(n, at.Svv);
        const double a = auu * avv - auv * auv;
        // a^-1 b
        const double c11 = (avv * buu - auv * buv) / a, c12 = (avv * buv - auv * bvv) / a;
        const double c21 = (auu * buv - auv * buu) / a, c22 = (auu * bvv - auv * buv) / a;
        const double muu = auu - gap.g * buu, muv = auv - gap.g * buv, mvv = avv - gap.g * bvv;
        const double m = muu * mvv - muv * muv;
        // -a^-1 b M^-1, symmetric
        const double h11 = -(c11 * mvv - c12 * muv) / m, h22 = -(c22 * muu - c21 * muv) / m;
        const double h12 = -0.5 * (c12 * muu - c11 * muv + c21 * mvv - c22 * muv) / m;
        for (int i = 0; i < 3; ++i)
            for (int k = i; k < 3; ++k)
                gap.H(i, k) = gap.H(k, i) = h11 * at.Su[i] * at.Su[k] + h22 * at.Sv[i] * at.Sv[k]
                                            + h12 * (at.Su[i] * at.Sv[k] + at.Sv[i] * at.Su[k]);
        return gap;
    }

    /// The nearest point goes along the edge as x does. eq. (4.168)
    Gap from_edge(const Vec3& r, const Found& found) const {
        const Vec3 &t = found.foot.at.Su, &k = found.foot.at.Suu;
        Gap gap = from_corner(r, normal_across(found), thirds_[found.third].across);
        if (gap.g == 0.0) return gap;
        const double stretch = dot(t, t) - dot(r, k);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gap.H(i, j) -= t[i] * t[j] / (stretch * gap.g);
        return gap;
    }

    /// Sum of the normals on both sides of an edge.
    Vec3 normal_across(const Found& found) const {
        const Third& third = thirds_[found.third];
        Vec3 sum = normalised(cross(found.foot.at.Su, found.foot.at.Sv));
        if (third.neighbour < 0) return sum;
        const PatchPoint other = thirds_[third.neighbour].patch.at({1.0 - found.foot.p.u, 0.0});
        const Vec3 n = normalised(cross(other.Su, other.Sv));
        for (int k = 0; k < 3; ++k) sum[k] += n[k];
        return sum;
    }

    /// Distance to a point, negative where the normals there look away; beside a rim all is outside. eq. (4.169)
    static Gap from_corner(const Vec3& r, const Vec3& normal, Across across) {
        const double rho = std::sqrt(dot(r, r));
        const double side = across == Across::Sharp && dot(r, normal) < 0.0 ? -1.0 : 1.0;
        if (rho == 0.0) return {0.0, normalised(normal), {}};
        Gap gap{side * rho, {side * r[0] / rho, side * r[1] / rho, side * r[2] / rho}, {}};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) gap.H(i, k) = ((i == k ? 1.0 : 0.0) - gap.n[i] * gap.n[k]) / gap.g;
        return gap;
    }

    static void put(const Gap& gap, int q, double* g, double* n, double* H) {
        g[q] = gap.g;
        std::copy(gap.n.begin(), gap.n.end(), n + 3 * q);
        std::copy(gap.H.a.begin(), gap.H.a.end(), H + 9 * q);
    }

    /// A patch lies in the hull of its points, and so does its box.
    static std::vector<Box> boxes(const std::vector<Third>& thirds) {
        std::vector<Box> boxes(thirds.size(), Box::empty());
        for (std::size_t i = 0; i < thirds.size(); ++i)
            for (const Vec3& x : thirds[i].patch.control) boxes[i].take_in(x);
        return boxes;
    }

    BoxTree tree_;
    std::vector<Third> thirds_;  // in the order of the tree
    std::vector<Flat> flats_;
    std::vector<Corner> corners_;
    ExactFaces exact_;
};

}  // namespace umform
