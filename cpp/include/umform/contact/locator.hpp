// Gaps of contact points. Facets that are far from the tool are not asked for: a distance falls no faster than they move.
#pragma once

#include <limits>
#include <memory>

#include "umform/assembly/threads.hpp"
#include "umform/contact/concept.hpp"
#include "umform/contact/facet.hpp"
#include "umform/surfaces/concept.hpp"

namespace umform {

/// Positions, gaps, normals and Hessians at the points of all facets. Where the tool is a distance, a facet is *far* if the
/// least gap of its points when it was last located, less the way that its nodes have gone since in the frame of the tool, is
/// more than its reach: no point of it can be held. eq. (4.40) The points of far facets are located when they are asked for.
template <int Nodes>
class Locator {
  public:
    using Values = std::array<double, Nodes>;

    /// Facet is a rule: shape functions N at its places, [place] or [facet][place] where facets differ.
    template <class Facet>
    Locator(Connectivity part, std::vector<double> X, const Facet& facet, std::shared_ptr<const Surface> surface)
        : part_(std::move(part)), X_(std::move(X)), N_(facet.N), points_(facet.places()),
          own_shapes_(static_cast<int>(N_.size()) > points_), largest_motion_(facet.largest_motion()),
          surface_(std::move(surface)), culls_(surface_->is_distance()) {
        number_nodes();
        const std::size_t facets = part_.size(), count = facets * points_;
        x_.resize(count), n_.resize(count), H_.resize(count), g_.resize(count);
        if (surface_->searches()) nearby_.resize(count);
        far_.assign(facets, 0), wanted_.assign(facets, 0);
        bound_.assign(facets, -std::numeric_limits<double>::infinity());
        if (culls_) least_ = bound_, located_at_.resize(facets);
    }

    const Connectivity& part() const { return part_; }
    std::size_t dofs() const { return X_.size(); }
    int points() const { return points_; }
    /// Shape functions at the points of a facet.
    const Values* shapes(int e) const { return N_.data() + (own_shapes_ ? static_cast<std::size_t>(e) * points_ : 0); }
    const std::vector<Values>& shapes() const { return N_; }
    const Pose& pose() const { return pose_; }
    bool far(int facet) const { return far_[facet] != 0; }

    /// Moves the facets to X + u and the tool to its pose, and locates all facets that are not far; reach(facet) is the largest gap
    /// at which one of its points can be held.
    template <class Reach>
    void move(const double* u, const Pose& pose, int threads, const Reach& reach) {
        pose_ = pose;
        const int nodes = static_cast<int>(nodes_.size());
        for_each_range(nodes, nodes < nodes_worth_a_team ? 1 : threads, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                for (int k = 0; k < 3; ++k) y_[i][k] = X_[3 * nodes_[i] + k] + u[3 * nodes_[i] + k];
                if (culls_) z_[i] = pose_.to_tool(y_[i]);
            }
        });
        for_each_range(part_.size(), part_.size() < facets_worth_a_team ? 1 : threads, [&](int first, int last) {
            for (int e = first; e < last; ++e) {
                bound_[e] = culls_ ? lower_bound(e) : -std::numeric_limits<double>::infinity();
                far_[e] = beyond(e, reach(e)) ? 1 : 0;
                wanted_[e] = far_[e] == 0;
            }
            if (surface_->is_concurrent()) locate_range(first, last);
        });
        if (!surface_->is_concurrent()) locate_at_once();
    }

    /// Locates the far facets that a reach, which has become larger, may touch.
    template <class Reach>
    void settle(const Reach& reach) {
        for (int e = 0; e < part_.size(); ++e) wanted_[e] = far(e) && !beyond(e, reach(e));
        locate_wanted(1);
    }

    /// Locates all facets that are far.
    void complete(int threads) {
        wanted_ = far_;
        locate_wanted(threads);
    }

    /// Position of a point of a facet in the frame of the tool, of far facets too: with the same bits as if it were located.
    Vec3 in_tool(int e, int q) const {
        return pose_.to_tool(far(e) ? pose_.to_space(on_facet(e, q)) : x_[e * points() + q]);
    }

    /// Where a node of a facet is.
    const Vec3& node(int e, int a) const { return y_[local_[e][a]]; }

    /// The places of a facet, for a law.
    Places places(int e) const {
        const std::size_t first = static_cast<std::size_t>(e) * points_;
        return {&g_[first], &x_[first], &n_[first], &H_[first], &pose_};
    }

    /// At the points of all facets, [facet][point]; those of far facets are what they were.
    const std::vector<Vec3>& positions() const { return x_; }
    const std::vector<Vec3>& normals() const { return n_; }
    const std::vector<Mat3>& hessians() const { return H_; }
    const std::vector<double>& gaps() const { return g_; }

  private:
    using LocalNodes = std::array<std::int32_t, Nodes>;

    void number_nodes() {
        nodes_ = part_.ids;
        std::sort(nodes_.begin(), nodes_.end());
        nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
        local_.resize(part_.size());
        for (int e = 0; e < part_.size(); ++e)
            for (int a = 0; a < Nodes; ++a)
                local_[e][a] = static_cast<std::int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), part_[e][a])
                                                         - nodes_.begin());
        y_.resize(nodes_.size());
        if (culls_) z_.resize(nodes_.size());
    }

    /// No point of a facet has a smaller gap; the last terms are far above the round-off of a gap.
    double lower_bound(int e) const {
        double way = 0.0, size = 0.0;
        for (int a = 0; a < Nodes; ++a) {
            const Vec3 &z = z_[local_[e][a]], &before = located_at_[e][a];
            const Vec3 d{z[0] - before[0], z[1] - before[1], z[2] - before[2]};
            way = std::max(way, dot(d, d));
            size += std::abs(z[0]) + std::abs(z[1]) + std::abs(z[2]);
        }
        return least_[e] - largest_motion_ * std::sqrt(way) - 1e-9 * (size + std::abs(least_[e]));
    }

    /// Whether a facet is farther than its reach, and has no penetration. NaN is not.
    bool beyond(int e, double reach) const { return bound_[e] > std::max(reach, 0.0); }

    void locate_wanted(int threads) {
        if (surface_->is_concurrent())
            for_each_range(part_.size(), part_.size() < facets_worth_a_team ? 1 : threads,
                           [&](int first, int last) { locate_range(first, last); });
        else
            locate_at_once();
    }

    /// Locates the wanted facets of a range, a run of neighbours with one call.
    void locate_range(int first, int last) {
        for (int begin = first; begin < last; ++begin) {
            if (wanted_[begin] == 0) continue;
            int end = begin;
            for (; end < last && wanted_[end] != 0; ++end) place(end);
            const std::size_t from = static_cast<std::size_t>(begin) * points();
            const int count = (end - begin) * points();
            if (nearby_.empty())
                surface_->gap(count, x_[from].data(), &g_[from], n_[from].data(), H_[from].a.data());
            else
                surface_->gap_again(count, x_[from].data(), &nearby_[from], &g_[from], n_[from].data(),
                                    H_[from].a.data());
            for (int e = begin; e < end; ++e) finish(e);
            begin = end;
        }
    }

    /// Evaluates the tool once for the points of all wanted facets: a function of a user.
    void locate_at_once() {
        std::vector<std::size_t> found;
        for (int e = 0; e < part_.size(); ++e) {
            if (wanted_[e] == 0) continue;
            place(e);
            for (int q = 0; q < points(); ++q) found.push_back(static_cast<std::size_t>(e) * points() + q);
        }
        if (found.empty()) return;
        std::vector<Vec3> x(found.size()), n(found.size());
        std::vector<Mat3> H(found.size());
        std::vector<double> g(found.size());
        for (std::size_t i = 0; i < found.size(); ++i) x[i] = x_[found[i]];
        surface_->gap(static_cast<int>(found.size()), x[0].data(), g.data(), n[0].data(), H[0].a.data());
        for (std::size_t i = 0; i < found.size(); ++i) g_[found[i]] = g[i], n_[found[i]] = n[i], H_[found[i]] = H[i];
        for (int e = 0; e < part_.size(); ++e)
            if (wanted_[e] != 0) finish(e);
    }

    /// Positions of the points of a facet, in the frame of the tool.
    void place(int e) {
        for (int q = 0; q < points(); ++q) x_[e * points() + q] = on_facet(e, q);
    }

    /// That of one point. eq. (4.18) Not inlined: all that ask get the same bits.
    [[gnu::noinline]] Vec3 on_facet(int e, int q) const {
        Vec3 x{};
        for (int a = 0; a < Nodes; ++a) {
            const Vec3& y = y_[local_[e][a]];
            for (int k = 0; k < 3; ++k) x[k] += shapes(e)[q][a] * y[k];
        }
        return pose_.to_tool(x);
    }

    /// From the frame of the tool into space; what later bounds need.
    void finish(int e) {
        double least = std::numeric_limits<double>::infinity();
        bool undefined = false;  // then the facet is never far
        for (int i = e * points(); i < (e + 1) * points(); ++i) {
            x_[i] = pose_.to_space(x_[i]);
            n_[i] = pose_.turn(n_[i]);
            H_[i] = pose_.turn(H_[i]);
            if (!(g_[i] > least)) least = g_[i];
            undefined = undefined || std::isnan(g_[i]);
        }
        far_[e] = 0;
        if (!culls_) return;
        least_[e] = undefined ? -std::numeric_limits<double>::infinity() : least - surface_->above();
        for (int a = 0; a < Nodes; ++a) located_at_[e][a] = z_[local_[e][a]];
    }

    Connectivity part_;
    std::vector<double> X_;
    std::vector<Values> N_;
    int points_;
    bool own_shapes_;
    double largest_motion_;
    std::shared_ptr<const Surface> surface_;
    bool culls_;

    std::vector<std::int32_t> nodes_;  // of all facets, sorted
    std::vector<LocalNodes> local_;    // [facet] numbers in nodes_
    Pose pose_;
    std::vector<Vec3> y_, z_;  // [node] in space, in the frame of the tool

    std::vector<Vec3> x_, n_;  // [facet][point]
    std::vector<Mat3> H_;
    std::vector<double> g_;
    std::vector<Nearby> nearby_;  // [facet][point] of a tool that searches

    std::vector<std::uint8_t> far_, wanted_;           // [facet]
    std::vector<double> bound_, least_;                // [facet] lower bound now, least gap when last located ...
    std::vector<std::array<Vec3, Nodes>> located_at_;  // ... with the nodes here, in the frame of the tool
};

}  // namespace umform
