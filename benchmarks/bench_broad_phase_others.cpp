/// \file bench_broad_phase_others.cpp
/// The search for pairs among random boxes by scree, by CGAL's box_self_intersection_d and by FCL's dynamic tree, on
/// the same boxes in turn, one thread; medians of processor time. All find the same number of pairs, or the program
/// fails. Usage: bench_broad_phase_others [number of boxes, default 1000000] [repetitions, default 5]
#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include <omp.h>

#include "broad_phase_scree.h"

namespace
{

double uniform(uint64_t &state)
{
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// Lower corner, then upper.
using Box = std::array<double, 6>;

/// As in scree bench broad-phase.
struct Kind
{
    const char *name;
    double smallest, elongation, volume_per_box;
};

const Kind kinds[] = {{"size 1:2", 0.5, 1, 2.6}, {"size 1:1000", 0.001, 1, 0.55}, {"elongation 1:50", 0.5, 50, 0.12}};

std::vector<Box> make_boxes(const Kind &kind, int64_t num)
{
    std::vector<Box> boxes(num);
    uint64_t state = 1;
    const double extent = std::cbrt(double(num) * kind.volume_per_box);
    for (Box &box : boxes)
    {
        const double size = kind.smallest * std::pow(1 / kind.smallest, uniform(state));
        for (int k = 0; k < 3; ++k)
        {
            const double middle = extent * (uniform(state) - 0.5);
            const double half = size * std::pow(kind.elongation, uniform(state) - 1);
            box[k] = middle - half;
            box[3 + k] = middle + half;
        }
    }
    return boxes;
}

double now()
{
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// One search, with all that belongs to it: returns the number of pairs.
using Search = std::function<int64_t(const std::vector<Box> &)>;

const double (*numbers_of(const std::vector<Box> &boxes))[6]
{
    return reinterpret_cast<const double(*)[6]>(boxes.data());
}

int64_t search_scree(const std::vector<Box> &boxes)
{
    return scree_bench_search_unsorted(numbers_of(boxes), int64_t(boxes.size()));
}

int64_t search_scree_sorted(const std::vector<Box> &boxes)
{
    return scree_bench_search_sorted(numbers_of(boxes), int64_t(boxes.size()));
}

int64_t search_cgal(const std::vector<Box> &boxes)
{
    using CgalBox = CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_EXPLICIT>;
    std::vector<CgalBox> list;
    list.reserve(boxes.size());
    for (const Box &b : boxes)
    {
        double lower[3] = {b[0], b[1], b[2]}, upper[3] = {b[3], b[4], b[5]};
        list.emplace_back(lower, upper);
    }
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    CGAL::box_self_intersection_d(list.begin(), list.end(),
                                  [&](const CgalBox &a, const CgalBox &b) { pairs.emplace_back(a.id(), b.id()); });
    return int64_t(pairs.size());
}

bool count_pair(fcl::CollisionObjectd *a, fcl::CollisionObjectd *b, void *data)
{
    auto &pairs = *static_cast<std::vector<std::pair<const void *, const void *>> *>(data);
    if (a->getAABB().overlap(b->getAABB())) pairs.emplace_back(a, b);
    return false;
}

/// The objects are made outside of the measured time; the tree is built from all of them at once.
std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
std::vector<fcl::CollisionObjectd *> object_pointers;

void make_objects(const std::vector<Box> &boxes)
{
    objects.clear();
    object_pointers.clear();
    for (const Box &b : boxes)
    {
        const auto shape = std::make_shared<fcl::Boxd>(b[3] - b[0], b[4] - b[1], b[5] - b[2]);
        const fcl::Vector3d middle(0.5 * (b[0] + b[3]), 0.5 * (b[1] + b[4]), 0.5 * (b[2] + b[5]));
        objects.push_back(std::make_unique<fcl::CollisionObjectd>(shape, fcl::Matrix3d::Identity(), middle));
        objects.back()->computeAABB();
        object_pointers.push_back(objects.back().get());
    }
}

int64_t search_fcl(const std::vector<Box> &)
{
    std::vector<std::pair<const void *, const void *>> pairs;
    fcl::DynamicAABBTreeCollisionManagerd manager;
    manager.registerObjects(object_pointers);
    manager.setup();
    manager.collide(&pairs, count_pair);
    return int64_t(pairs.size());
}

void measure(const Kind &kind, int64_t num, int num_repeats)
{
    const std::vector<Box> boxes = make_boxes(kind, num);
    make_objects(boxes);
    const std::pair<const char *, Search> ways[] = {{"scree, unsorted", search_scree},
                                                    {"scree, sorted, with rows", search_scree_sorted},
                                                    {"CGAL box_self_intersection_d", search_cgal},
                                                    {"FCL dynamic AABB tree", search_fcl}};
    std::vector<double> times[4];
    int64_t num_pairs[4] = {0, 0, 0, 0};
    for (int r = -1; r < num_repeats; ++r)
        for (int w = 0; w < 4; ++w)
        {
            const double start = now();
            num_pairs[w] = ways[w].second(boxes);
            if (r >= 0) times[w].push_back(now() - start); // the first round makes room
        }
    double unit = 0;
    for (int w = 0; w < 4; ++w)
    {
        std::sort(times[w].begin(), times[w].end());
        const double median = times[w][times[w].size() / 2];
        if (w == 0) unit = median;
        std::printf("%-16s %-30s %9.1f ms  %6.2f times the first  %lld pairs\n", kind.name, ways[w].first, 1e3 * median,
                    median / unit, (long long)num_pairs[w]);
        // middles and sizes of FCL's boxes are rounded, so a pair that just touches may differ
        if (num_pairs[w] < 0 || std::llabs(num_pairs[w] - num_pairs[0]) > num / 1000000 + 1)
        {
            std::fprintf(stderr, "bench_broad_phase_others: the numbers of pairs differ\n");
            std::exit(EXIT_FAILURE);
        }
    }
}

} // namespace

int main(int argc, char **argv)
{
    omp_set_num_threads(1);
    const int64_t num = argc > 1 ? std::strtoll(argv[1], nullptr, 10) : 1000000;
    const int num_repeats = argc > 2 ? std::atoi(argv[2]) : 5;
    for (const Kind &kind : kinds) measure(kind, num, num_repeats);
    return 0;
}
