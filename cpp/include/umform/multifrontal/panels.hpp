// How the columns of a front and of its update are stored.
#pragma once

#include <algorithm>
#include <cstddef>

namespace umform::multifrontal {

/// Places of the columns of a matrix. Of a symmetric one they are stored by panels that begin at the diagonal of their first
/// column, so that a panel is a matrix for BLAS and little is stored above the diagonal. Stored rows begin at the diagonal at
/// the latest.
class Panels {
  public:
    Panels() = default;

    /// Columns of the factor of a front: `columns` of `rows` rows.
    static Panels of_factor(std::size_t rows, std::size_t columns, bool symmetric) {
        return {rows, columns, 0, symmetric ? std::max(kNarrow, (columns / kPanels + 15) / 16 * 16) : 0};
    }
    /// A square matrix, of which all rows of the first columns are stored: those that could not be eliminated. Panels are narrow
    /// in small updates.
    static Panels of_update(std::size_t order, std::size_t left, bool symmetric) {
        return {order, order, left, !symmetric ? 0 : order - left < 400 ? kNarrow : kWide};
    }

    /// Numbers of all columns.
    std::size_t size() const {
        if (width_ == 0) return columns_ * rows_;
        const std::size_t beyond = columns_ - left_, panels = (beyond + width_ - 1) / width_;
        if (panels == 0) return left_ * rows_;
        const std::size_t last = beyond - (panels - 1) * width_;
        return left_ * rows_ + before(panels - 1) + last * (rows_ - left_ - (panels - 1) * width_);
    }
    /// Where row 0 of a column would lie.
    std::size_t column(std::size_t j) const {
        if (width_ == 0 || j < left_) return j * rows_;
        const std::size_t panel = (j - left_) / width_, first = panel * width_;
        return left_ * rows_ + before(panel) + (j - left_ - first) * (rows_ - left_ - first) - left_ - first;
    }
    /// From a column to the next one of its panel.
    std::size_t stride(std::size_t j) const {
        return width_ == 0 || j < left_ ? rows_ : rows_ - left_ - (j - left_) / width_ * width_;
    }
    /// First column of the panel of a column.
    std::size_t begin(std::size_t j) const {
        return width_ == 0 || j < left_ ? 0 : left_ + (j - left_) / width_ * width_;
    }
    /// First column behind it.
    std::size_t end(std::size_t j) const {
        if (width_ == 0) return columns_;
        return j < left_ ? left_ : std::min(columns_, begin(j) + width_);
    }
    /// Columns of a panel; 0 where all rows of all columns are stored.
    std::size_t width() const { return width_; }
    /// Are there rows that are not stored?
    bool parted() const { return width_ != 0 && columns_ - left_ > width_; }
    /// About a half of so many columns from `begin` on: up to the panel that begins nearest to their middle, if one begins
    /// among them.
    int half(int begin, int count) const {
        const int width = static_cast<int>(width_), even = (count / 2 + 15) / 16 * 16;
        if (!parted()) return even;
        const int nearest = (begin + count / 2 + width / 2) / width * width - begin;
        return 0 < nearest && nearest < count ? nearest : even;
    }

  private:
    /// Wide enough for products that are as fast as those of all columns; so many panels leave little above the diagonal.
    static constexpr std::size_t kNarrow = 48, kWide = 96, kPanels = 16;
    std::size_t rows_ = 0, columns_ = 0, left_ = 0, width_ = 0;

    Panels(std::size_t rows, std::size_t columns, std::size_t left, std::size_t width)
        : rows_(rows), columns_(columns), left_(left), width_(width) {}

    /// Numbers of the first panels.
    std::size_t before(std::size_t panels) const {
        return panels == 0 ? 0 : width_ * (panels * (rows_ - left_) - width_ * (panels * (panels - 1) / 2));
    }
};

/// The columns of a front that are eliminated, or those of its update.
struct DenseColumns {
    double* data = nullptr;
    Panels panels;

    /// Row 0 of a column, where it would lie.
    double* column(std::size_t j) const { return data + panels.column(j); }
    double* at(std::size_t i, std::size_t j) const { return column(j) + i; }
    int stride(std::size_t j) const { return static_cast<int>(panels.stride(j)); }
    int begin(std::size_t j) const { return static_cast<int>(panels.begin(j)); }
    /// Columns from j on that are in its panel, at most so many.
    int together(std::size_t j, int count) const { return std::min(count, static_cast<int>(panels.end(j) - j)); }
    /// Calls take(entry, j) for the entries of a row in columns from `begin` to `end`.
    template <class Take>
    void for_row(int i, int begin, int end, const Take& take) const {
        for (int j = begin; j < end;) {
            double* entry = at(i, j);
            const int step = stride(j);
            for (const int last = j + together(j, end - j); j < last; ++j, entry += step) take(*entry, j);
        }
    }
};

}  // namespace umform::multifrontal
