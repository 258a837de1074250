extern "C" {
#include "assets/halfmesh/loops.h"
}

/* In OpenMesh's properties, which are inlined. Clang has no such warning. */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <unordered_map>
#include <vector>

namespace
{

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Halfedge = OpenMesh::HalfedgeHandle;

constexpr size_t NONE = SIZE_MAX;

struct Builder {
    Mesh mesh;
    std::vector<uint32_t> source;                /* of each mesh vertex: its vertex in the source */
    std::unordered_map<uint64_t, unsigned> uses; /* triangles at each side */
    std::vector<unsigned> faces;                 /* of each vertex of the source */
    size_t refused = 0;
};

/* A side of the boundary; `next` in the same list. */
struct Side {
    uint32_t from, to, triangle;
    size_t next; /* NONE: not known */
};

uint64_t key_of(uint32_t a, uint32_t b)
{
    return static_cast<uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

OpenMesh::VertexHandle add_vertex(Builder &builder, uint32_t vertex)
{
    builder.source.push_back(vertex);
    return builder.mesh.add_vertex(Mesh::Point(0, 0, 0));
}

void add_face(Builder &builder, const uint32_t *v)
{
    /* OpenMesh goes round a vertex for each face that it gets, which takes the square of their number. */
    const unsigned max_faces = 128;
    OpenMesh::VertexHandle corners[3];
    bool crowded = false;
    for (size_t k = 0; k < 3; k++) {
        corners[k] = OpenMesh::VertexHandle(static_cast<int>(v[k]));
        builder.uses[key_of(v[k], v[(k + 1) % 3])]++;
        crowded |= builder.faces[v[k]]++ >= max_faces;
    }
    if (!crowded && builder.mesh.add_face(corners, 3).is_valid())
        return;
    builder.refused++;
    for (size_t k = 0; k < 3; k++)
        corners[k] = add_vertex(builder, v[k]);
    builder.mesh.add_face(corners, 3);
}

void build(Builder &builder, const tl_loop_source &source)
{
    omerr().disable(); /* refused faces are counted */
    builder.faces.resize(source.vertex_count);
    builder.mesh.reserve(source.vertex_count, 3 * source.triangle_count, source.triangle_count);
    for (size_t i = 0; i < source.vertex_count; i++)
        add_vertex(builder, static_cast<uint32_t>(i));
    for (size_t t = 0; t < source.triangle_count; t++)
        add_face(builder, source.triangles[t]);
}

bool is_boundary(const Builder &builder, Halfedge half, uint32_t &from, uint32_t &to)
{
    if (!builder.mesh.is_boundary(half))
        return false;
    from = builder.source[static_cast<size_t>(builder.mesh.from_vertex_handle(half).idx())];
    to = builder.source[static_cast<size_t>(builder.mesh.to_vertex_handle(half).idx())];
    return builder.uses.at(key_of(from, to)) == 1;
}

/* The boundary's sides in order of their triangles, each with the one that OpenMesh has after it, if that is
 * a side too. */
std::vector<Side> collect(const Builder &builder)
{
    const Mesh &mesh = builder.mesh;
    std::vector<Side> sides;
    std::vector<size_t> number(mesh.n_halfedges(), NONE);
    std::vector<Halfedge> halves;
    for (size_t f = 0; f < mesh.n_faces(); f++)
        for (Halfedge inner : mesh.fh_range(OpenMesh::FaceHandle(static_cast<int>(f)))) {
            Halfedge half = mesh.opposite_halfedge_handle(inner);
            uint32_t from, to;
            if (!is_boundary(builder, half, from, to))
                continue;
            number[static_cast<size_t>(half.idx())] = sides.size();
            sides.push_back({from, to, static_cast<uint32_t>(f), NONE});
            halves.push_back(half);
        }
    for (size_t i = 0; i < sides.size(); i++)
        sides[i].next = number[static_cast<size_t>(mesh.next_halfedge_handle(halves[i]).idx())];
    return sides;
}

/* Leaves out sides that no side leads to or from, such as a fin's, and those that only these lead to or from:
 * they are parts of no loop. */
std::vector<Side> prune(const std::vector<Side> &sides)
{
    std::unordered_map<uint32_t, std::vector<size_t>> leaving, arriving; /* sides of each vertex */
    std::unordered_map<uint32_t, size_t> begins, ends;                   /* how many of them are left */
    for (size_t i = 0; i < sides.size(); i++) {
        leaving[sides[i].from].push_back(i);
        arriving[sides[i].to].push_back(i);
        begins[sides[i].from]++;
        ends[sides[i].to]++;
    }
    std::vector<bool> dropped(sides.size());
    std::vector<size_t> open;
    auto examine = [&](size_t i) {
        if (!dropped[i] && (ends[sides[i].from] == 0 || begins[sides[i].to] == 0)) {
            dropped[i] = true;
            open.push_back(i);
        }
    };
    for (size_t i = 0; i < sides.size(); i++)
        examine(i);
    while (!open.empty()) {
        const Side &side = sides[open.back()];
        open.pop_back();
        if (--begins[side.from] == 0)
            std::for_each(arriving[side.from].begin(), arriving[side.from].end(), examine);
        if (--ends[side.to] == 0)
            std::for_each(leaving[side.to].begin(), leaving[side.to].end(), examine);
    }
    std::vector<size_t> number(sides.size(), NONE);
    std::vector<Side> kept;
    for (size_t i = 0; i < sides.size(); i++)
        if (!dropped[i]) {
            number[i] = kept.size();
            kept.push_back(sides[i]);
        }
    for (Side &side : kept)
        side.next = side.next == NONE ? NONE : number[side.next];
    return kept;
}

/* Joins a line that a refused face ended to a side that begins there and that none leads to. */
void link(std::vector<Side> &sides)
{
    std::vector<char> led_to(sides.size());
    std::unordered_multimap<uint32_t, size_t> begins;
    for (const Side &side : sides)
        if (side.next != NONE)
            led_to[side.next] = 1;
    for (size_t i = sides.size(); i-- > 0;)
        if (!led_to[i])
            begins.emplace(sides[i].from, i);
    for (Side &side : sides) {
        auto found = side.next == NONE ? begins.find(side.to) : begins.end();
        if (found == begins.end())
            continue;
        side.next = found->second;
        begins.erase(found);
    }
}

template <typename T> T *new_array(size_t count)
{
    T *array = static_cast<T *>(std::malloc(std::max<size_t>(count, 1) * sizeof(T)));
    if (!array)
        throw std::bad_alloc();
    return array;
}

/* Loops as they are found, and the sides of all of them. */
struct Found {
    std::vector<size_t> first = {0}, order;
};

/* Follows a line from a side. Where it comes back to a vertex, the way from there was a loop; what is left
 * when it ends is no loop. `at` is the place on the line of each vertex that is on it, else NONE. */
void follow(const std::vector<Side> &sides, size_t start, std::vector<char> &taken, std::vector<size_t> &at,
            Found &found)
{
    std::vector<size_t> line;
    for (size_t now = start; now != NONE && !taken[now]; now = sides[now].next) {
        taken[now] = 1;
        at[sides[now].from] = line.size();
        line.push_back(now);
        size_t back = at[sides[now].to];
        if (back == NONE)
            continue;
        for (size_t i = back; i < line.size(); i++) {
            at[sides[line[i]].from] = NONE;
            found.order.push_back(line[i]);
        }
        line.resize(back);
        found.first.push_back(found.order.size());
    }
    for (size_t side : line)
        at[sides[side].from] = NONE;
}

void write(const std::vector<Side> &sides, size_t vertex_count, tl_loops *out)
{
    std::vector<char> taken(sides.size());
    std::vector<size_t> at(vertex_count, NONE);
    Found found;
    for (size_t start = 0; start < sides.size(); start++)
        follow(sides, start, taken, at, found);
    out->count = found.first.size() - 1;
    out->first = new_array<size_t>(found.first.size());
    out->sides = new_array<tl_loop_side>(found.order.size());
    std::copy(found.first.begin(), found.first.end(), out->first);
    for (size_t i = 0; i < found.order.size(); i++)
        out->sides[i] = {sides[found.order[i]].from, sides[found.order[i]].triangle};
}

} // namespace

bool tl_loops_find(const struct tl_loop_source *source, struct tl_loops *out)
{
    *out = tl_loops{};
    try {
        Builder builder;
        build(builder, *source);
        std::vector<Side> sides = prune(collect(builder));
        link(sides);
        write(sides, source->vertex_count, out);
        out->refused = builder.refused;
        return true;
    } catch (const std::exception &) {
        tl_loops_release(out);
        return false;
    }
}

void tl_loops_release(struct tl_loops *loops)
{
    std::free(loops->first);
    std::free(loops->sides);
    *loops = tl_loops{};
}
