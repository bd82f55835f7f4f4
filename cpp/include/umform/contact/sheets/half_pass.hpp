// A half pass: the contact points of one face against the facets of another one, with forces on both.
#pragma once

#include <limits>

#include "umform/contact/cells.hpp"
#include "umform/contact/facet.hpp"
#include "umform/contact/sheets/couplings.hpp"
#include "umform/contact/sheets/pass.hpp"
#include "umform/contact/sheets/place.hpp"
#include "umform/contact/sheets/search.hpp"

namespace umform {

/// Faces<Nodes> is FacetPoints or FacetCells: the places of a facet, and their areas.
template <int Nodes, template <int> class Faces>
class HalfPass final : public SheetPass {
  public:
    using Values = std::array<double, Nodes>;
    static constexpr bool over_cells = requires(const Faces<Nodes>& faces) { faces.corners_of(0); };

    template <class Rule>
    HalfPass(Connectivity part, Connectivity others, CutEdges edges, const std::vector<double>& X, Rule rule,
             SheetSetting numbers, std::vector<std::vector<std::int32_t>> near)
        : SheetPass(std::move(numbers)), part_(std::move(part)), faces_(part_, X, rule),
          other_(std::move(others), std::move(edges), x_) {
        candidates_.near = std::move(near);
        X_.resize(X.size() / 3), x_.resize(X_.size());
        for (std::size_t i = 0; i < X.size(); ++i) X_[i / 3][i % 3] = X[i];
        x_ = X_;
        nodes_ = part_.ids;
        nodes_.insert(nodes_.end(), other_.facets().ids.begin(), other_.facets().ids.end());
        nodes_.insert(nodes_.end(), other_.rims().nodes().ids.begin(), other_.rims().nodes().ids.end());
        std::sort(nodes_.begin(), nodes_.end());
        nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
        history_ = History(part_.size(), faces_.count(), SheetHistory::table.list());
        feet_.resize(static_cast<std::size_t>(part_.size()) * faces_.places());
        found_.resize(points());
        parts_.resize(part_.size()), scale_.assign(part_.size(), 0.0);
        candidates_.of.resize(part_.size());
    }

    std::size_t dofs() const override { return 3 * X_.size(); }
    bool symmetric() const override { return false; }
    int points() const override { return static_cast<int>(faces_.area.size()); }
    int per_facet() const override { return faces_.count(); }
    const std::vector<double>& areas() const override { return faces_.area; }
    int nodes() const override { return Nodes; }
    std::vector<double> shape_values() const override {
        std::vector<double> values;
        for (std::size_t e = 0; e < faces_.N.size(); e += faces_.places())
            for (int q = 0; q < per_facet(); ++q) {
                const Values& N = faces_.N[e + q];
                values.insert(values.end(), N.begin(), N.end());
            }
        return values;
    }

    void search(const double* u, double way, double turn) override {
        move(u);
        searched_ = x_, turned_ = normals();
        // Two facets touch only if they look at each other, which takes a turn of both.
        const double any = std::cos(std::acos(facing(false)) - 2.0 * turn);
        const double near = std::cos(std::acos(facing(true)) - 2.0 * turn);
        const auto may_meet = [&](int e, int m) {
            return !other_.rims().of(m).empty()
                   || dot(turned_[e], turned_[part_.size() + m]) < (candidates_.close(e, m) ? near : any);
        };
        candidates_.template search<Nodes>(part_, other_.facets(), other_.boxes(), x_,
                                           setting.deepest + setting.highest + 2.0 * way, thread_count(), may_meet);
        for (int e = 0; e < part_.size(); ++e)  // the converged feet stay
            for (int q = 0; q < per_facet(); ++q) {
                const std::int32_t facet = remembered(e, q);
                auto& list = candidates_.of[e];
                const auto at = std::lower_bound(list.begin(), list.end(), facet);
                if (facet >= 0 && (at == list.end() || *at != facet)) list.insert(at, facet);
            }
    }

    std::array<double, 2> moved_since_search(const double* u) override {
        constexpr double endless = std::numeric_limits<double>::infinity();
        if (searched_.empty()) return {endless, endless};
        move(u);
        double largest = 0.0, least = 1.0;
        for (const std::int32_t node : nodes_) {
            const Vec3 &a = x_[node], &b = searched_[node];
            const Vec3 d{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
            largest = std::max(largest, dot(d, d));
        }
        const std::vector<Vec3> now = normals();
        for (std::size_t k = 0; k < now.size(); ++k) least = std::min(least, dot(now[k], turned_[k]));
        return {std::sqrt(largest), std::acos(std::max(least, -1.0))};
    }

    Connectivity couplings() const override {
        return Couplings<Nodes>(part_, other_, candidates_, !symmetric_places(), static_cast<int>(X_.size())).pairs();
    }

    Outcome evaluate(const double* u, const Pattern& pattern, const Target& target) override {
        if (target.values != nullptr && pattern.symmetric && !symmetric())
            throw std::invalid_argument("the tangent of " + name
                                        + " is not symmetric: its matrix needs a pattern of both triangles");
        const int threads = part_.size() < facets_worth_a_team ? 1 : thread_count().load();
        move(u);
        other_.update(target.wants_tangent(), threads);
        for_each_range(part_.size(), threads, [&](int first, int last) {
            for (int e = first; e < last; ++e) locate(e), form(e, target.wants_tangent());
        });
        Outcome outcome;  // added facet by facet: the same bits for any number of threads
        for (int e = 0; e < part_.size(); ++e) {
            if (parts_[e].nodes.empty()) continue;
            parts_[e].add(pattern, target);
            outcome.force_scale_squared += scale_[e];
        }
        return outcome;
    }

    SheetFound found() const override {
        SheetFound all;
        for (int q = 0; q < points(); ++q) {
            const OfPoint& point = found_[q];
            all.status.push_back(point.status), all.facet.push_back(point.facet);
            all.gap.push_back(point.gap), all.pressure.push_back(point.pressure);
            all.x.push_back(point.x), all.normal.push_back(point.n), all.traction.push_back(point.traction);
            const double area = setting.share * faces_.area[q];
            const double* row = history_.point(q);
            all.slip.push_back(row[SheetHistory::Slip]);
            all.stored += area * row[SheetHistory::Stored];
            all.friction_work += area * row[SheetHistory::Rubbed];
            const bool along_the_way = over_cells || setting.augmented;
            all.contact_energy += area * row[along_the_way ? SheetHistory::Work : SheetHistory::Energy];
            if (point.status == 0) continue;
            all.penetration = std::max(all.penetration, -point.gap);
            const double force =
                area * std::max(setting.penalty, setting.friction.stiffness) * std::sqrt(dot(point.x, point.x));
            all.round_off_squared += force * force;
        }
        return all;
    }

  private:
    struct OfPoint {
        std::uint8_t status = 0;
        std::int32_t facet = -1;
        double gap = 0.0, pressure = 0.0;
        Vec3 x{}, n{}, traction{};
    };

    using Place = SheetPlace<Nodes>;
    using Rows = PartRows<Nodes>;

    static constexpr double at_corner = 1.0 / 12.0;  // share of a corner of a cell in its force

    static constexpr double flush = 0.01;  // a rim begins so far beyond its edge, in deepest penetrations
    /// Faces that lie on each other touch, whatever round-off makes of their gap.
    double slack() const { return 1e-11 * setting.deepest; }

    /// The gap at which a multiplier alone is the pressure becomes zero. eq. (4.33)
    double shift(int e, int q) const { return multiplier(e * per_facet() + q) / setting.penalty; }

    std::array<Vec3, Nodes> nodes_of(const std::int32_t* ids) const { return umform::nodes_of<Nodes>(ids, x_); }
    bool symmetric_places() const { return !over_cells && setting.friction.law == nullptr; }
    const Values* shapes(int e) const { return faces_.N.data() + (over_cells ? e * faces_.places() : 0); }
    std::size_t at(int e, int place) const { return static_cast<std::size_t>(e) * faces_.places() + place; }
    std::int32_t remembered(int e, int q) const {
        return static_cast<std::int32_t>(history_.state(e)[history_.size() * q + SheetHistory::Facet]) - 1;
    }

    void move(const double* u) {
        for (const std::int32_t node : nodes_)
            for (int k = 0; k < 3; ++k) x_[node][k] = X_[node][k] + u[3 * node + k];
    }

    /// Cosine between the normals of two facets below which they look at each other.
    static double facing(bool close) { return close ? -0.3 : 0.0; }

    /// Normals at the middle of the facets of this face, then of the other one.
    std::vector<Vec3> normals() const {
        std::vector<Vec3> all(part_.size() + other_.facets().size());
        for (int e = 0; e < part_.size(); ++e) all[e] = middle_normal(nodes_of(part_[e]));
        for (int m = 0; m < other_.facets().size(); ++m)
            all[part_.size() + m] = middle_normal(nodes_of(other_.facets()[m]));
        return all;
    }

    static Vec3 middle_normal(const std::array<Vec3, Nodes>& x) {
        const FaceShape<Nodes> shape = face_shape<Nodes>(0.0, 0.0);
        return normalised(cross(combined<Nodes>(shape.Nr, x), combined<Nodes>(shape.Ns, x)));
    }

    /// Feet of all places of a facet.
    void locate(int e) {
        const auto x = nodes_of(part_[e]);
        const Vec3 n = middle_normal(x);
        FacetBox own = box_of<Nodes>(x);
        own.grow(setting.deepest + setting.highest);
        std::vector<std::int32_t> near;
        std::vector<NearRim> rims;
        for (const std::int32_t m : candidates_.of[e]) {
            const double least = facing(candidates_.close(e, m));
            if (dot(n, other_.normal(m)) < least && own.meets(other_.box(m))) near.push_back(m);
            for (const int edge : other_.rims().of(m))
                if (own.meets(other_.rims().box(edge))) rims.push_back({edge, least});
        }
        for (int q = 0; q < faces_.places(); ++q) {
            FacetFoot& foot = feet_[at(e, q)];
            foot = FacetFoot{};
            if (near.empty() && rims.empty()) continue;
            const Vec3 place = combined<Nodes>(shapes(e)[q], x);
            const bool mean = q < faces_.count();
            const double farther = mean ? 1.0 : 2.0;  // corners of cells may be farther
            const double deepest = farther * setting.deepest, highest = farther * setting.highest;
            // The gaps at its corners say how much of a cell is off an edge; its force acts at the continued facet. Places on the edges of
            // two sheets that lie flush stay on the face.
            const double over_cut = over_cells && mean ? setting.highest : flush * setting.deepest;
            other_.closest(near, place, deepest, highest, over_cut, foot);
            if (!foot.found()) other_.closest_rim(rims, n, place, deepest, highest, foot);
        }
    }

    /// The part of a cell in contact, from the gaps at its corners; those that are beyond the other face have the gap of the facet of
    /// the mean place, continued. Whether all corners have one.
    bool overlap(int e, int q, Overlap& overlap, std::array<FacetFoot, 4>& corners) const {
        if constexpr (over_cells) {
            const FacetFoot& mean = feet_[at(e, q)];
            const auto places = faces_.corners_of(q);
            std::array<double, 4> G;
            for (int i = 0; i < 4; ++i) {
                corners[i] = feet_[at(e, places[i])];
                if (!corners[i].found()) {
                    const Vec3 x = combined<Nodes>(shapes(e)[places[i]], nodes_of(part_[e]));
                    double along;
                    if (!(mean.rim < 0 ? project<Nodes>(other_.at(mean.facet), x, 4.0, corners[i])
                                       : other_.rims().at(mean.rim).project(x, corners[i], along)))
                        return false;
                    corners[i].facet = mean.facet, corners[i].rim = mean.rim;
                }
                G[i] = corners[i].gap - slack() - shift(e, q);
            }
            overlap = Cut(G).overlap;
        }
        return true;
    }

    /// Reactions of a facet, its forces and tangent, and what its points remember.
    void form(int e, bool tangent) {
        LoosePart& part = parts_[e];
        part.nodes.clear(), scale_[e] = 0.0;
        std::vector<Slot> met;
        std::vector<int> held;
        std::vector<Overlap> overlaps(per_facet());
        std::vector<std::array<FacetFoot, 4>> corners(over_cells ? per_facet() : 0);
        for (int q = 0; q < per_facet(); ++q) {
            const FacetFoot& foot = feet_[at(e, q)];
            OfPoint& point = found_[e * per_facet() + q];
            point = OfPoint{};
            point.x = combined<Nodes>(shapes(e)[q], nodes_of(part_[e]));
            point.gap = std::numeric_limits<double>::quiet_NaN();
            if (foot.found()) point.facet = foot.facet, point.gap = foot.gap, point.n = foot.n;
            bool touches = foot.found() && foot.gap - shift(e, q) <= slack();
            if constexpr (over_cells)
                touches = foot.found() && overlap(e, q, overlaps[q], corners[q]) && overlaps[q].share > 0.0;
            if (!touches) {
                leave(e, q, foot);
                continue;
            }
            if (held.empty()) part.nodes.assign(part_[e], part_[e] + Nodes), part.others = part.nodes;
            held.push_back(q);
            other_.slot(part, met, foot);
            if (setting.friction.law != nullptr && remembered(e, q) >= 0) other_.slot(part, met, remembered(e, q));
            if constexpr (over_cells)
                for (const FacetFoot& corner : corners[q])
                    other_.slot(part, met, corner), other_.slot(part, met, corner.facet);
        }
        if (held.empty()) return;
        part.start(tangent);
        for (const int q : held) add_point(e, q, overlaps[q], over_cells ? &corners[q] : nullptr, tangent, part, met);
        for (const double value : part.f) scale_[e] += value * value;
    }

    /// A place that nothing holds.
    void leave(int e, int q, const FacetFoot& foot) {
        using H = SheetHistory;
        const double* state = history_.state(e) + history_.size() * q;
        double* trial = history_.trial(e) + history_.size() * q;
        std::fill_n(trial, history_.size(), 0.0);
        trial[H::Slip] = state[H::Slip];
        trial[H::Rubbed] = state[H::Rubbed] + state[H::Stored];  // what was stored is lost
        trial[H::Work] = state[H::Work] - state[H::Energy];
        if (!foot.found() || foot.rim >= 0) return;
        trial[H::Facet] = foot.facet + 1, trial[H::Where] = foot.r, trial[H::Where + 1] = foot.s;
        trial[H::Gap] = foot.gap;
        for (int k = 0; k < 3; ++k) trial[H::Normal + k] = foot.n[k];
    }

    /// The converged foot of a place, and its coefficients.
    Anchor anchor_of(int e, int q, const Vec3& x, FaceShape<Nodes>& shape) const {
        using H = SheetHistory;
        Anchor anchor;
        const double* state = history_.state(e) + history_.size() * q;
        anchor.slip = state[H::Slip];
        const std::int32_t facet = remembered(e, q);
        if (facet < 0) return anchor;
        const OnFacet<Nodes> there(other_.at(facet), state[H::Where], state[H::Where + 1]);
        anchor.known = true, anchor.held = state[H::Held] != 0.0;
        anchor.gap = state[H::Gap] > slack() ? state[H::Gap] : 0.0;
        for (int k = 0; k < 3; ++k) anchor.d[k] = x[k] - there.y[k];
        for (int k = 0; k < 3 && anchor.held; ++k) anchor.above[k] = state[H::Gap] * state[H::Normal + k];
        anchor.tau = there.tau;
        anchor.traction = {state[H::Traction], state[H::Traction + 1]};
        shape = there.shape;
        return anchor;
    }

    void add_point(int e, int q, const Overlap& overlap, const std::array<FacetFoot, 4>* corners, bool tangent,
                   LoosePart& part, std::vector<Slot>& met) {
        OfPoint& point = found_[e * per_facet() + q];
        const double weight = setting.share * faces_.area[e * per_facet() + q];
        if (over_cells) point.gap = overlap.gap + shift(e, q);
        point.pressure = setting.penalty * (shift(e, q) - point.gap);
        const auto place = [&](const FacetFoot& foot, int where) {
            const Values& N = shapes(e)[where];
            return Place(foot, N, combined<Nodes>(N, nodes_of(part_[e])), tangent, other_, part, met);
        };
        const Place mean = place(feet_[at(e, q)], q);
        std::vector<Place> around;
        if constexpr (over_cells)
            for (int i = 0; i < 4; ++i) around.push_back(place((*corners)[i], faces_.corners_of(q)[i]));
        Rows slope(1, tangent ? part.columns() : 0);  // of the pressure
        if (tangent && !over_cells) mean.add_gap(-setting.penalty, slope);
        for (std::size_t i = 0; tangent && i < around.size(); ++i)
            around[i].add_gap(-setting.penalty * overlap.by_corner[i], slope);

        // The pressure of a cell acts at its corners too, by Simpson's rule, unless they are off the other face; where they are off a
        // cut edge it acts on the continued facet. eq. (4.308)
        double at_mean = 1.0;
        point.traction = {};  // the sum of what acts: each corner has a normal of its own
        const auto push = [&](double part_of_cell, const Place& place) {
            const Vec3 t = place.add_pressure(part_of_cell * weight, point.pressure, slope, tangent, part);
            for (int k = 0; k < 3; ++k) point.traction[k] += part_of_cell * t[k];
        };
        for (std::size_t i = 0; i < around.size(); ++i) {
            if (around[i].foot.rim >= 0) {
                if constexpr (over_cells) {
                    const int where = faces_.corners_of(q)[i];
                    const Vec3 x = combined<Nodes>(shapes(e)[where], nodes_of(part_[e]));
                    FacetFoot continued;
                    if (!other_.over_cut(x, around[i].foot, continued)) continue;
                    push(at_corner, place(continued, where));
                }
            } else {
                if (around[i].foot.beyond() > OtherFace<Nodes>::edge) continue;
                push(at_corner, around[i]);
            }
            at_mean -= at_corner;
        }
        push(at_mean, mean);
        SheetReaction rubbed;
        if (const auto* on = mean.on_facet(); on != nullptr && setting.friction.law != nullptr) {
            FaceShape<Nodes> of_anchor;
            const Anchor anchor = anchor_of(e, q, point.x, of_anchor);
            rub<Nodes>(setting.friction, mean.foot, on->moves, anchor, point.x, point.pressure, rubbed);
            for (int k = 0; k < 3; ++k) point.traction[k] += rubbed.tangential[k];
            on->add_force(weight, rubbed, slope, tangent, part);
            if (tangent && anchor.known)
                on->add_anchor(weight, rubbed, shapes(e)[q], of_anchor, other_.slot(part, met, remembered(e, q)), part);
        }
        point.status = rubbed.slips ? 2 : 1;
        remember(e, q, mean, overlap, point, rubbed);
    }

    void remember(int e, int q, const Place& place, const Overlap& overlap, const OfPoint& point,
                  const SheetReaction& reaction) {
        using H = SheetHistory;
        const FacetFoot& foot = place.foot;
        const auto* on = place.on_facet();
        const double* state = history_.state(e) + history_.size() * q;
        double* trial = history_.trial(e) + history_.size() * q;
        // Faces that only lie on each other do not hold: friction begins with pressure.
        const double lies = 2.0 * setting.penalty * slack();
        trial[H::Held] = point.pressure > lies || multiplier(e * per_facet() + q) > 0.0 ? 1.0 : 0.0;
        trial[H::Facet] = on != nullptr ? foot.facet + 1 : 0;  // nothing rubs on a rim
        trial[H::Where] = foot.r, trial[H::Where + 1] = foot.s;
        trial[H::Gap] = foot.gap, trial[H::Pressure] = point.pressure;
        for (int k = 0; k < 3; ++k) trial[H::Normal + k] = foot.n[k];
        for (int a = 0; a < 2; ++a)
            trial[H::Traction + a] = on != nullptr ? dot(reaction.tangential, on->moves.dual[a]) : 0.0;
        trial[H::Slip] = state[H::Slip] + reaction.slid;
        const double elastic = dot(reaction.tangential, reaction.tangential);
        trial[H::Stored] = setting.friction.law == nullptr ? 0.0 : 0.5 * elastic / setting.friction.stiffness;
        trial[H::Rubbed] = state[H::Rubbed] + reaction.work - trial[H::Stored] + state[H::Stored];
        const bool squares = over_cells && !setting.augmented;
        trial[H::Energy] = squares ? setting.penalty * overlap.half_square : -0.5 * point.pressure * point.gap;
        trial[H::Multiplier] = multiplier(e * per_facet() + q);
        double work = trial[H::Energy] - state[H::Energy];
        if (state[H::Pressure] > 0.0) work = -0.5 * (state[H::Pressure] + point.pressure) * (foot.gap - state[H::Gap]);
        trial[H::Work] = state[H::Work] + work;
    }

    std::vector<Vec3> X_, x_, searched_;  // [node]
    std::vector<Vec3> turned_;            // normals of both faces at the search
    Connectivity part_;
    Faces<Nodes> faces_;
    OtherFace<Nodes> other_;
    Candidates candidates_;
    std::vector<std::int32_t> nodes_;  // of both faces, sorted
    std::vector<FacetFoot> feet_;      // [facet][place]
    std::vector<OfPoint> found_;       // [facet][point]
    std::vector<LoosePart> parts_;     // [facet] without nodes where nothing is held
    std::vector<double> scale_;
};

}  // namespace umform
