// What a contact law is to the facets: a place against the tool and its history in, traction and its derivative out.
#pragma once

#include <concepts>
#include <vector>

#include "umform/assembly/history.hpp"
#include "umform/contact/pose.hpp"

namespace umform {

class NormalLaw;

/// The law of a user by which the pressure follows from the gap, and what it is times; none where it follows from the penalty.
struct GivenPressure {
    const NormalLaw* law = nullptr;
    double scale = 1.0;
};

/// What the history of every contact law begins with.
struct ContactHistory {
    static constexpr VariableTable table{{{"multiplier"}}};
    enum { Multiplier = table["multiplier"] };
};

/// A place of a face (a Gauss point or a node) against the tool, in space. A law that knows a slip keeps it in the frame of the
/// tool, where the place is at pose.to_tool(x).
struct Place {
    double gap;  // signed distance, negative in penetration
    const Vec3 &x, &n;
    const Mat3& H;
    const Pose& pose;
};

/// What the tool does to the sheet at a place: a traction on the reference area, in its parts along and across the normal.
struct Reaction {
    bool held;         // if not, the rest has no meaning
    bool slipping;     // whether the tangential traction is at its bound
    double pressure;   // along n, positive
    Vec3 tangential;   // across n
    double K[3][3];    // minus the derivative of the traction with respect to x
    Vec3 by_pressure;  // of `press` only: derivative of the traction with respect to the pressure, which K keeps fixed

    Vec3 traction(const Vec3& n) const {
        Vec3 t;
        for (int k = 0; k < 3; ++k) t[k] = pressure * n[k] + tangential[k];
        return t;
    }
    /// On the sheet, of an area. eq. (4.9)
    Vec3 force(const Vec3& n, double area) const {
        Vec3 f;
        for (int k = 0; k < 3; ++k) f[k] = area * pressure * n[k] + area * tangential[k];
        return f;
    }
};

/// What friction holds and has cost at a place, per area.
struct Rubbing {
    Vec3 elastic_slip{};  // now, in the frame of the tool
    double slip = 0.0;    // distance slid in all
    double stored = 0.0, work = 0.0;
    double above = 0.0;      // part of the work that the mean traction of each increment misses. eq. (4.220)
    double stiffness = 0.0;  // traction per elastic slip
};

/// A law answers at one place. Its `table` names what it remembers, which begins with the multiplier of the normal direction. `state` is the converged history,
/// which is never changed; `trial` comes with the multiplier that is wanted now and takes the rest of the new history. `reach` is
/// the largest gap at which the place can be held. `respond` says whether it is held, and writes the reaction then, without
/// `held`. A law that is `symmetric` has a symmetric K; what is below its diagonal is not read. One that
/// `follows_places` has more to say: what it remembers of a place that the tool does not hold, or no longer (`leave`), what friction
/// does there (`rubbing`), how its tangential multipliers are set (`augment`), belong to what was read (`put_wanted`), and become
/// those of the new history (`settle`). A law that may be asked over cells also has `press`, the response to a pressure that
/// comes from elsewhere than the gap of the place, with a K that is not symmetric.
template <class L>
concept PlaceLaw =
    requires(const L& law, L& mutable_law, const Place& place, const double* state, double* trial, Reaction& reaction) {
        { L::symmetric } -> std::convertible_to<bool>;
        { L::follows_places } -> std::convertible_to<bool>;
        requires L::table["multiplier"] == ContactHistory::Multiplier;
        { mutable_law.penalty } -> std::same_as<double&>;
        { law.stiffness(state) } -> std::same_as<double>;
        { law.reach(trial) } -> std::same_as<double>;
        { law.respond(place, state, trial, reaction) } -> std::same_as<bool>;
    };

/// Places of a facet, arrays [place].
struct Places {
    const double* gap;
    const Vec3 *x, *n;
    const Mat3* H;
    const Pose* pose;

    Place operator[](int q) const { return {gap[q], x[q], n[q], H[q], *pose}; }
};

/// History of the places of a facet: the converged one and that of now, rows of `size` numbers, those of the law first.
struct HistoryRows {
    const double* state;
    double* trial;
    int size, of_law;
};

/// The law as the facets see it: one virtual call for all places of a facet.
class ContactLaw {
  public:
    virtual ~ContactLaw() = default;
    virtual bool symmetric() const = 0;
    virtual bool follows_places() const = 0;
    virtual std::vector<HistoryVariable> history_variables() const = 0;
    /// Pressure per penetration.
    virtual double penalty() const = 0;
    virtual void set_penalty(double value) = 0;
    virtual GivenPressure given_pressure() const { return {}; }
    /// Largest traction per way of a place in any direction, from its history.
    virtual double stiffness(const double* history) const = 0;
    /// Largest gap at which one of `count` places can be held, from rows of `size` numbers.
    virtual double reach(int count, const double* trial, int size) const = 0;
    /// Reactions at `count` places.
    virtual void respond(int count, const Places& places, const HistoryRows& rows, Reaction* reactions) const = 0;
    /// The same under pressures that are given, where `held` says that there is one.
    virtual void press(int count, const Places& places, const double* pressures, const HistoryRows& rows,
                       Reaction* reactions) const = 0;
    // Of one place, and of laws that follow places only; z is in the frame of the tool.
    virtual void leave(const Vec3& z, const double* state, double* trial) const = 0;
    /// The same where the tool has been opened: loads do what it did, and take what it has stored.
    virtual void let_go(const Vec3& z, const double* state, double* trial) const = 0;
    virtual Rubbing rubbing(const double* history) const = 0;
    virtual void augment(const Place& place, const Vec3& t, const double* state, double* trial) const = 0;
    virtual void put_wanted(const double* trial, double* read) const = 0;
    virtual void settle(double* trial) const = 0;
};

template <PlaceLaw Law>
class ContactLawOf final : public ContactLaw {
  public:
    explicit ContactLawOf(Law law) : law_(std::move(law)) {}
    bool symmetric() const override { return Law::symmetric; }
    bool follows_places() const override { return Law::follows_places; }
    std::vector<HistoryVariable> history_variables() const override { return Law::table.list(); }
    double penalty() const override { return law_.penalty; }
    void set_penalty(double value) override { law_.penalty = value; }
    GivenPressure given_pressure() const override {
        if constexpr (requires { law_.normal; }) return {law_.normal.get(), law_.scale()};
        return {};
    }
    double stiffness(const double* history) const override { return law_.stiffness(history); }
    double reach(int count, const double* trial, int size) const override {
        double largest = law_.reach(trial);
        for (int q = 1; q < count; ++q) largest = std::max(largest, law_.reach(trial + q * size));
        return largest;
    }
    void respond(int count, const Places& places, const HistoryRows& rows, Reaction* reactions) const override {
        if constexpr (requires { law_.respond_all(count, places, rows, reactions); }) {
            law_.respond_all(count, places, rows, reactions);
            return;
        }
        for (int q = 0; q < count; ++q)
            reactions[q].held =
                law_.respond(places[q], rows.state + q * rows.size, rows.trial + q * rows.size, reactions[q]);
    }
    void press(int count, const Places& places, const double* pressures, const HistoryRows& rows,
               Reaction* reactions) const override {
        for (int q = 0; q < count; ++q) {
            const double* state = rows.state + q * rows.size;
            double* trial = rows.trial + q * rows.size;
            if constexpr (requires { law_.press(places[q], 1.0, state, trial, reactions[q]); }) {
                if (reactions[q].held) {
                    law_.press(places[q], pressures[q], state, trial, reactions[q]);
                    continue;
                }
            }
            reactions[q].held = false;
            leave(places.pose->to_tool(places.x[q]), state, trial);
        }
    }
    void leave(const Vec3& z, const double* state, double* trial) const override {
        if constexpr (Law::follows_places) law_.leave(z, state, trial);
    }
    void let_go(const Vec3& z, const double* state, double* trial) const override {
        leave(z, state, trial);
        if constexpr (requires { law_.forget_work(state, trial); }) law_.forget_work(state, trial);
    }
    Rubbing rubbing(const double* history) const override {
        if constexpr (Law::follows_places) return law_.rubbing(history);
        return {};
    }
    void augment(const Place& place, const Vec3& t, const double* state, double* trial) const override {
        if constexpr (Law::follows_places) law_.augment(place, t, state, trial);
    }
    void put_wanted(const double* trial, double* read) const override {
        if constexpr (Law::follows_places) law_.put_wanted(trial, read);
    }
    void settle(double* trial) const override {
        if constexpr (Law::follows_places) law_.settle(trial);
    }

  private:
    Law law_;
};

}  // namespace umform
