#include "cloth/solvers/implicit/factor_shim.h"

#define EIGEN_MPL2_ONLY
#define EIGEN_DONT_PARALLELIZE
#include <Eigen/SparseCholesky>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

namespace
{

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Cholesky = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

/* A triplet with the accessors that Eigen's setFromTriplets calls. */
struct Triplet {
    struct tl_triplet of;
    int row() const { return of.row; }
    int col() const { return of.column; }
    double value() const { return of.value; }
};
static_assert(sizeof(Triplet) == sizeof(struct tl_triplet), "an array of one is an array of the other");

template <typename T> T *copy_array(const T *from, size_t count)
{
    T *copy = static_cast<T *>(std::malloc((count > 0 ? count : 1) * sizeof(T)));
    if (!copy)
        throw std::bad_alloc();
    if (count > 0)
        std::memcpy(copy, from, count * sizeof(T));
    return copy;
}

bool factorise(int count, const Triplet *triplets, size_t triplet_count, double min_pivot,
               struct tl_sparse_factor *out)
{
    Matrix matrix(count, count);
    matrix.setFromTriplets(triplets, triplets + triplet_count);
    Cholesky cholesky;
    cholesky.setShift(min_pivot); /* rounding makes no pivot 0, at which Eigen would stop */
    cholesky.compute(matrix);
    if (cholesky.info() != Eigen::Success)
        return false;
    const Matrix &lower = cholesky.matrixL().nestedExpression();
    out->count = static_cast<size_t>(count);
    out->order = copy_array(cholesky.permutationPinv().indices().data(), out->count);
    out->first = copy_array(lower.outerIndexPtr(), out->count + 1);
    out->rows = copy_array(lower.innerIndexPtr(), static_cast<size_t>(out->first[count]));
    out->values = copy_array(lower.valuePtr(), static_cast<size_t>(out->first[count]));
    const Eigen::VectorXd pivots = cholesky.vectorD();
    out->pivots = copy_array(pivots.data(), out->count);
    for (size_t j = 0; j < out->count; j++)
        out->pivots[j] = std::fmax(out->pivots[j], min_pivot);
    return true;
}

bool is_finite(const struct tl_sparse_factor *factor)
{
    bool finite = true;
    for (size_t j = 0; j < factor->count; j++)
        finite = finite && std::isfinite(factor->pivots[j]);
    for (int e = 0; e < factor->first[factor->count]; e++)
        finite = finite && std::isfinite(factor->values[e]);
    return finite;
}

} // namespace

extern "C" bool tl_sparse_factor_create(size_t count, const struct tl_triplet *triplets, size_t triplet_count,
                                        double min_pivot, struct tl_sparse_factor *out)
{
    *out = tl_sparse_factor{};
    bool good = false;
    try {
        good = factorise(static_cast<int>(count), reinterpret_cast<const Triplet *>(triplets), triplet_count,
                         min_pivot, out) &&
               is_finite(out);
    } catch (const std::bad_alloc &) {
        good = false;
    }
    if (!good)
        tl_sparse_factor_release(out);
    return good;
}

extern "C" void tl_sparse_factor_release(struct tl_sparse_factor *factor)
{
    std::free(factor->order);
    std::free(factor->first);
    std::free(factor->rows);
    std::free(factor->values);
    std::free(factor->pivots);
    *factor = tl_sparse_factor{};
}
