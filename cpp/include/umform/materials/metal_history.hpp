// What a metal from parts remembers: plastic strain and eqps always, the rest as its parts need it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "umform/assembly/history_variables.hpp"
#include "umform/materials/plastic_increment.hpp"

namespace umform {

/// The parts of the history in their order, and where each one begins; -1 for one that the metal does not have. The kinematic work is
/// that done on back stresses, a falling modulus or a rate.
class MetalHistory {
  public:
    static constexpr VariableTable always{{{"plastic_strain", 6}, {"eqps"}}};
    enum { PlasticStrain = always["plastic_strain"], Eqps = always["eqps"] };

    int kinematic_work = -1;
    std::array<int, Chaboche::largest> back_stress;
    int inner_back_stress = -1, bounding_growth = -1, stagnation_centre = -1, stagnation_radius = -1;
    int overstress = -1;

    explicit MetalHistory(const MetalParts& parts)
        : MetalHistory(!parts.associated_only(), parts.back_stress.count(), parts.two_surfaces.active(),
                       parts.rate.active()) {}
    /// Numbers of the longest one.
    static constexpr int largest() { return MetalHistory(true, Chaboche::largest, true, true).size(); }

    constexpr int size() const { return size_; }
    std::vector<HistoryVariable> list() const {
        std::vector<HistoryVariable> history_variables = always.list();
        for (int k = 0; k < count_; ++k) history_variables.push_back({std::string(more_[k].name), more_[k].size});
        return history_variables;
    }

  private:
    constexpr MetalHistory(bool kinematic, int back_stresses, bool two_surfaces, bool rate) : back_stress{} {
        constexpr std::array<std::string_view, Chaboche::largest> names{"back_stress_1", "back_stress_2",
                                                                        "back_stress_3", "back_stress_4"};
        if (kinematic) kinematic_work = add({"kinematic_work"});
        for (int k = 0; k < back_stresses; ++k) back_stress[k] = add({names[k], 6});
        if (two_surfaces) {
            inner_back_stress = add({"inner_back_stress", 6});
            bounding_growth = add({"bounding_growth"});
            stagnation_centre = add({"stagnation_centre", 6});
            stagnation_radius = add({"stagnation_radius"});
        }
        if (rate) overstress = add({"overstress"});
    }

    constexpr int add(VariableRow row) {
        const int place = size_;
        more_[count_++] = row;
        size_ += row.size;
        return place;
    }

    std::array<VariableRow, 6 + Chaboche::largest> more_{};
    int count_ = 0, size_ = always.size();
};

}  // namespace umform
