extern "C" {
#include "assets/halfmesh/decimate.h"
#include "assets/halfmesh/quadric.h"
}

/* In OpenMesh's properties, which are inlined. Clang has no such warning. */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <new>
#include <numeric>
#include <vector>

namespace
{

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Halfedge = OpenMesh::HalfedgeHandle;
using Vec = OpenMesh::Vec3d;

constexpr size_t RING = 32; /* vertices with more faces stay */
constexpr int NONE = -1;

/* New edges may be this many times as long as the sides of equal triangles of the target's number: light is
 * computed at vertices, and a shadow on a flat back is as sharp as they are close. */
constexpr double LONGEST = 1.6;

/* A collapse costs as much as a mean distance of this share of its longest new edge, where the surface is
 * flatter than that: there it keeps vertices evenly spaced. */
constexpr double EVENNESS = 0.004;

/* One collapse may turn a triangle by 45 degrees. */
constexpr double TURN_COS = 0.7;

/* 1: an equilateral triangle, 0: a line. New triangles are no worse than this, or than the worst before. */
constexpr double SHAPE = 0.25;

/* The share of the time that passes before the first collapse. */
constexpr double BUILDING = 0.3;

/* A vertex of the mesh: a place, or one that a refused face has for its own. */
struct Node {
    Vec position;
    tl_quadric quadric = {};
    double area = 0;    /* of the faces that its quadric has */
    bool stays = false; /* may not be removed, or is gone */
};

/* A face by its number in the mesh, which it keeps while its neighbours vanish. */
struct Facet {
    std::array<int, 3> nodes;
    std::array<uint32_t, 3> corners; /* vertices of the source */
    int first_point = NONE;          /* removed vertices that are nearest to it: a list */
    uint32_t source;
};

/* A vertex of the source that was removed. */
struct Point {
    int next = NONE;
    double squared = 0; /* distance from its face, m^2 */
};

struct Decimation {
    const tl_decimate_source *source;
    Mesh mesh;
    std::vector<Node> nodes;
    std::vector<Facet> faces;
    std::vector<Point> points;   /* [source's vertex_count] */
    std::vector<double> due;     /* [node] the cost at which it has its turn; INFINITY: none */
    std::vector<char> lines;     /* [edge] OpenMesh's own flags take as long to read as the rest of a ring */
    std::vector<double> strayed; /* [edge] of a line: what it has replaced is no farther from it, m */
    size_t triangles = 0;
    double longest = 0; /* m, for new edges */
};

/* The neighbourhood of a node, counter-clockwise. Facet i lies between spokes i and i + 1, NONE outside of
 * the border. A ring with lines begins at one. */
struct Ring {
    int hub;
    size_t count, lines;
    size_t other_line; /* the spoke that is a line besides spoke 0, when there are two */
    std::array<Halfedge, RING> spokes;
    std::array<int, RING> ends, faces;

    size_t after(size_t spoke) const { return spoke + 1 < count ? spoke + 1 : 0; }
    size_t before(size_t spoke) const { return (spoke > 0 ? spoke : count) - 1; }
    bool is_line(size_t spoke) const { return lines > 0 && (spoke == 0 || spoke == other_line); }
    /* Faces on one side of a line that leads through the hub are a sector. */
    size_t sector(size_t face) const { return lines > 0 && face >= other_line ? 1 : 0; }
};

struct Candidate {
    size_t spoke;
    double cost;
};

/* A followed point and its place after a collapse. */
struct Moved {
    uint32_t point;
    int face;
    double squared;
};

/* Halfedges 2 i and 2 i + 1 are those of edge i. */
bool is_line(const Decimation &work, Halfedge half)
{
    return work.lines[static_cast<size_t>(half.idx()) / 2] != 0;
}

/* False for a node that must stay: lines end or cross there, or it has too many faces. */
bool find_ring(const Decimation &work, int hub, Ring &ring)
{
    const Mesh &mesh = work.mesh;
    OpenMesh::VertexHandle vertex(hub);
    Halfedge start = mesh.halfedge_handle(vertex), half = start;
    if (work.nodes[static_cast<size_t>(hub)].stays || !start.is_valid())
        return false;
    ring.hub = hub;
    ring.count = ring.lines = 0;
    do {
        if (is_line(work, half)) {
            if (ring.lines++ == 0)
                start = half;
        }
        if (ring.count++ == RING)
            return false;
        half = mesh.ccw_rotated_halfedge_handle(half);
    } while (half != mesh.halfedge_handle(vertex));
    if (ring.count < 3 - (ring.lines > 0) || (ring.lines != 0 && ring.lines != 2))
        return false;
    half = start;
    for (size_t i = 0; i < ring.count; i++) {
        ring.spokes[i] = half;
        ring.ends[i] = mesh.to_vertex_handle(half).idx();
        ring.faces[i] = mesh.face_handle(half).idx();
        if (i > 0 && ring.lines > 0 && is_line(work, half))
            ring.other_line = i;
        half = mesh.ccw_rotated_halfedge_handle(half);
    }
    return true;
}

double squared_length(const Vec &v)
{
    return v | v;
}

/* The cost of the collapse onto a spoke's end, before it is known to be allowed: m^2 times the area, so that
 * what covers little is removed first. */
double cost_of(const Decimation &work, const Ring &ring, size_t spoke)
{
    const Node &hub = work.nodes[static_cast<size_t>(ring.hub)],
               &target = work.nodes[static_cast<size_t>(ring.ends[spoke])];
    double longest = 0;
    for (size_t i = 0; i < ring.count; i++)
        longest = std::max(longest, squared_length(work.nodes[static_cast<size_t>(ring.ends[i])].position -
                                                   target.position));
    double error = tl_quadric_at(&hub.quadric, target.position.data()) +
                   tl_quadric_at(&target.quadric, target.position.data());
    return std::max(error, 0.0) + EVENNESS * EVENNESS * longest * (hub.area + target.area);
}

/* The possible collapses, the cheapest first. */
size_t find_candidates(const Decimation &work, const Ring &ring, std::array<Candidate, RING> &out)
{
    size_t count = 0;
    for (size_t i = 0; i < ring.count; i++)
        if (ring.lines == 0 || ring.is_line(i))
            out[count++] = {i, cost_of(work, ring, i)};
    std::sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Candidate &a, const Candidate &b) {
                  return a.cost < b.cost || (a.cost == b.cost && a.spoke < b.spoke);
              });
    return count;
}

/* Whether a face of a ring remains when the hub moves to a spoke's end. */
bool remains(const Ring &ring, size_t spoke, size_t face)
{
    return ring.faces[face] != NONE && face != spoke && face != ring.before(spoke);
}

/* The distance of a collapsed line from what its new side stands for. */
double line_stray(const Decimation &work, const Ring &ring, size_t spoke)
{
    size_t other = spoke == 0 ? ring.other_line : 0;
    auto edge = [&](size_t i) { return static_cast<size_t>(work.mesh.edge_handle(ring.spokes[i]).idx()); };
    auto at = [&](int node) { return work.nodes[static_cast<size_t>(node)].position.data(); };
    return std::max(work.strayed[edge(spoke)], work.strayed[edge(other)]) +
           tl_segment_distance(at(ring.hub), at(ring.ends[spoke]), at(ring.ends[other]));
}

/* Whether what is left has a surface: a tetrahedron would collapse onto itself. */
bool is_open_enough(Decimation &work, const Ring &ring, size_t spoke)
{
    Mesh &mesh = work.mesh;
    return mesh.is_collapse_ok(ring.spokes[spoke]) &&
           (ring.lines > 0 || mesh.valence(OpenMesh::VertexHandle(ring.ends[ring.after(spoke)])) > 3 ||
            mesh.valence(OpenMesh::VertexHandle(ring.ends[ring.before(spoke)])) > 3);
}

/* Checks the topology, the triangles' shapes and the line of a collapse. */
bool is_sound(Decimation &work, const Ring &ring, size_t spoke)
{
    size_t after = ring.after(spoke), before = ring.before(spoke);
    if (ring.lines == 2 && ((ring.is_line(after) && ring.faces[spoke] != NONE) ||
                            (ring.is_line(before) && ring.faces[before] != NONE)))
        return false; /* a triangle between both lines would vanish, and a line with it */
    if (ring.lines == 2 && !(line_stray(work, ring, spoke) <= work.source->distance_max_m))
        return false;
    const Vec hub = work.nodes[static_cast<size_t>(ring.hub)].position,
              target = work.nodes[static_cast<size_t>(ring.ends[spoke])].position;
    double worst_before = 1, worst_after = 1;
    for (size_t i = 0; i < ring.count; i++) {
        if (ring.faces[i] == NONE)
            continue;
        const Vec &a = work.nodes[static_cast<size_t>(ring.ends[i])].position,
                  &b = work.nodes[static_cast<size_t>(ring.ends[ring.after(i)])].position;
        Vec old_normal = (a - hub) % (b - hub);
        double old_area = old_normal.norm();
        worst_before = std::min(worst_before, tl_triangle_shape(hub.data(), a.data(), b.data(), old_area));
        if (!remains(ring, spoke, i))
            continue;
        Vec normal = (a - target) % (b - target);
        double area = normal.norm();
        if (!((normal | old_normal) >= TURN_COS * area * old_area) || !(area > 0) ||
            squared_length(a - target) > work.longest * work.longest ||
            squared_length(b - target) > work.longest * work.longest)
            return false;
        worst_after = std::min(worst_after, tl_triangle_shape(target.data(), a.data(), b.data(), area));
    }
    return worst_after >= std::min(SHAPE, worst_before) && is_open_enough(work, ring, spoke);
}

/* A ring as it is after a collapse. */
struct Folded {
    size_t count = 0;
    std::array<size_t, RING> faces;                    /* of the ring, that remain */
    double places[RING][3][3];                         /* of their corners */
    std::array<std::array<uint32_t, 3>, RING> corners; /* vertices of the source */
};

size_t slot_of(const Facet &face, int node)
{
    return face.nodes[0] == node ? 0 : face.nodes[1] == node ? 1 : 2;
}

/* The vertex of the source that a collapse puts in place of the hub's in a sector. */
uint32_t target_corner(const Decimation &work, const Ring &ring, size_t spoke, size_t sector)
{
    size_t beside = ring.faces[spoke] != NONE && ring.sector(spoke) == sector ? spoke : ring.before(spoke);
    const Facet &face = work.faces[static_cast<size_t>(ring.faces[beside])];
    return face.corners[slot_of(face, ring.ends[spoke])];
}

void fold(const Decimation &work, const Ring &ring, size_t spoke, Folded &folded)
{
    folded.count = 0;
    for (size_t i = 0; i < ring.count; i++) {
        if (!remains(ring, spoke, i))
            continue;
        const Facet &face = work.faces[static_cast<size_t>(ring.faces[i])];
        size_t n = folded.count++, slot = slot_of(face, ring.hub);
        folded.faces[n] = i;
        folded.corners[n] = face.corners;
        folded.corners[n][slot] = target_corner(work, ring, spoke, ring.sector(i));
        for (size_t k = 0; k < 3; k++)
            std::copy_n(
                work.nodes[static_cast<size_t>(k == slot ? ring.ends[spoke] : face.nodes[k])].position.data(),
                3, folded.places[n][k]);
    }
}

Vec position_of(const Decimation &work, uint32_t vertex)
{
    const float *p = work.source->positions[vertex];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/* Finds a point's nearest face of its sector. False if it is too far away, or has another UV there. */
bool place(const Decimation &work, const Ring &ring, const Folded &folded, size_t sector, uint32_t point,
           std::vector<Moved> &moved)
{
    const tl_decimate_source &source = *work.source;
    const Vec x = position_of(work, point);
    double squared = INFINITY, weights[3] = {1, 0, 0};
    size_t best = 0;
    for (size_t n = 0; n < folded.count; n++) {
        double found[3], distance;
        if (ring.sector(folded.faces[n]) != sector)
            continue;
        distance = tl_triangle_nearest(x.data(), folded.places[n], found);
        if (!(distance < squared))
            continue;
        squared = distance;
        best = n;
        std::copy(found, found + 3, weights);
    }
    if (!(squared <= source.distance_max_m * source.distance_max_m))
        return false;
    double off = 0;
    for (size_t c = 0; c < 2; c++) {
        double uv = -static_cast<double>(source.uvs[point][c]);
        for (size_t k = 0; k < 3; k++)
            uv += weights[k] * static_cast<double>(source.uvs[folded.corners[best][k]][c]);
        off += uv * uv;
    }
    const int face = ring.faces[folded.faces[best]];
    double metres =
        static_cast<double>(source.uv_metres[source.parts[work.faces[static_cast<size_t>(face)].source]]);
    if (!(metres * std::sqrt(off) <= source.uv_max_m))
        return false;
    moved.push_back({point, face, squared});
    return true;
}

/* Places the hub's vertices and all points of its faces. False if one of them would be too far away. */
bool place_all(const Decimation &work, const Ring &ring, const Folded &folded, std::vector<Moved> &moved)
{
    moved.clear();
    bool placed[2] = {false, false};
    for (size_t i = 0; i < ring.count; i++) {
        if (ring.faces[i] == NONE)
            continue;
        const Facet &face = work.faces[static_cast<size_t>(ring.faces[i])];
        size_t sector = ring.sector(i);
        if (!placed[sector] &&
            !place(work, ring, folded, sector, face.corners[slot_of(face, ring.hub)], moved))
            return false;
        placed[sector] = true;
        for (int p = face.first_point; p != NONE; p = work.points[static_cast<size_t>(p)].next)
            if (!place(work, ring, folded, sector, static_cast<uint32_t>(p), moved))
                return false;
    }
    return true;
}

void collapse(Decimation &work, const Ring &ring, size_t spoke, const Folded &folded,
              const std::vector<Moved> &moved)
{
    if (ring.lines == 2) {
        size_t other = spoke == 0 ? ring.other_line : 0; /* OpenMesh keeps this edge */
        work.strayed[static_cast<size_t>(work.mesh.edge_handle(ring.spokes[other]).idx())] =
            line_stray(work, ring, spoke);
    }
    for (size_t i = 0; i < ring.count; i++)
        if (ring.faces[i] != NONE) {
            work.faces[static_cast<size_t>(ring.faces[i])].first_point = NONE;
            work.triangles -= !remains(ring, spoke, i);
        }
    for (size_t n = 0; n < folded.count; n++) {
        Facet &face = work.faces[static_cast<size_t>(ring.faces[folded.faces[n]])];
        face.nodes[slot_of(face, ring.hub)] = ring.ends[spoke];
        face.corners = folded.corners[n];
    }
    for (const Moved &to : moved) {
        Facet &face = work.faces[static_cast<size_t>(to.face)];
        work.points[to.point] = {face.first_point, to.squared};
        face.first_point = static_cast<int>(to.point);
    }
    Node &target = work.nodes[static_cast<size_t>(ring.ends[spoke])],
         &hub = work.nodes[static_cast<size_t>(ring.hub)];
    tl_quadric_add(&target.quadric, &hub.quadric);
    target.area += hub.area;
    hub.stays = true;
    work.mesh.collapse(ring.spokes[spoke]);
}

/* ---- The mesh ---- */

int add_node(Decimation &work, Vec position)
{
    work.nodes.push_back({});
    work.nodes.back().position = position;
    return work.mesh.add_vertex(Mesh::Point(0, 0, 0)).idx();
}

/* Adds a face. If it is refused, it gets three nodes of its own; they and those that they stand for stay, so
 * that the surface is closed where it was. `uses` counts the faces of each node: OpenMesh goes round a vertex
 * for each face that it gets, which takes the square of their number. */
void add_face(Decimation &work, size_t triangle, const std::vector<int> &node_of, std::vector<uint32_t> &uses)
{
    const uint32_t max_faces = 128;
    const tl_decimate_source &source = *work.source;
    Facet face;
    OpenMesh::VertexHandle handles[3];
    bool crowded = false;
    for (size_t k = 0; k < 3; k++) {
        face.corners[k] = source.triangles[triangle][k];
        face.nodes[k] = node_of[source.weld[face.corners[k]]];
        handles[k] = OpenMesh::VertexHandle(face.nodes[k]);
        crowded |= uses[static_cast<size_t>(face.nodes[k])]++ >= max_faces;
    }
    if (face.nodes[0] == face.nodes[1] || face.nodes[1] == face.nodes[2] || face.nodes[2] == face.nodes[0])
        return;
    if (crowded || !work.mesh.add_face(handles, 3).is_valid()) {
        for (size_t k = 0; k < 3; k++) {
            Node &node = work.nodes[static_cast<size_t>(face.nodes[k])];
            node.stays = true;
            face.nodes[k] = add_node(work, node.position);
            work.nodes.back().stays = true;
            handles[k] = OpenMesh::VertexHandle(face.nodes[k]);
        }
        work.mesh.add_face(handles, 3);
    }
    face.source = static_cast<uint32_t>(triangle);
    work.faces.push_back(face);
}

/* Marks the border, and the sides at which the two faces have different vertices, or belong to different
 * parts. */
void mark_lines(Decimation &work)
{
    Mesh &mesh = work.mesh;
    work.lines.assign(mesh.n_edges(), 1);
    work.strayed.resize(mesh.n_edges());
    for (size_t e = 0; e < mesh.n_edges(); e++) {
        OpenMesh::EdgeHandle edge(static_cast<int>(e));
        if (mesh.is_boundary(edge))
            continue;
        Halfedge half = mesh.halfedge_handle(edge, 0);
        const Facet &one = work.faces[static_cast<size_t>(mesh.face_handle(half).idx())],
                    &other = work.faces[static_cast<size_t>(mesh.opposite_face_handle(half).idx())];
        bool is_line = work.source->parts[one.source] != work.source->parts[other.source];
        for (int node : {mesh.from_vertex_handle(half).idx(), mesh.to_vertex_handle(half).idx()})
            is_line |= one.corners[slot_of(one, node)] != other.corners[slot_of(other, node)];
        work.lines[e] = is_line;
    }
}

/* Gives each node the planes of its faces; returns the area of all. */
double weigh(Decimation &work)
{
    double sum = 0;
    for (const Facet &face : work.faces) {
        Node *nodes[3];
        for (size_t k = 0; k < 3; k++)
            nodes[k] = &work.nodes[static_cast<size_t>(face.nodes[k])];
        Vec normal = (nodes[1]->position - nodes[0]->position) % (nodes[2]->position - nodes[0]->position);
        double length = normal.norm();
        if (!(length > 0))
            continue;
        for (Node *node : nodes) {
            tl_quadric_add_plane(&node->quadric, (normal / length).data(), nodes[0]->position.data(),
                                 length / 2);
            node->area += length / 2;
        }
        sum += length / 2;
    }
    return sum;
}

/* A number whose order keeps neighbours in space together: the bits of a point's coordinates, interleaved
 * [Morton 1966]. `scale`: steps per metre. */
uint64_t morton_of(const Vec &point, const Vec &lower, double scale)
{
    uint64_t code = 0;
    for (size_t c = 0; c < 3; c++) {
        uint64_t step = static_cast<uint64_t>((point[c] - lower[c]) * scale);
        for (unsigned bit = 0; bit < 21; bit++)
            code |= (step >> bit & 1) << (3 * bit + c);
    }
    return code;
}

/* The places' numbers in the order of space: nodes that collapse one after the other are then close in
 * memory. */
std::vector<uint32_t> order_places(const std::vector<Vec> &places)
{
    Vec lower = places[0], upper = places[0];
    for (const Vec &place : places)
        for (size_t c = 0; c < 3; c++) {
            lower[c] = std::min(lower[c], place[c]);
            upper[c] = std::max(upper[c], place[c]);
        }
    double size = std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2], 1e-9});
    std::vector<uint64_t> codes;
    for (const Vec &place : places)
        codes.push_back(morton_of(place, lower, 2097151 / size));
    std::vector<uint32_t> order(places.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return codes[a] < codes[b] || (codes[a] == codes[b] && a < b); });
    return order;
}

/* Makes a node of each place; returns the node of each. */
std::vector<int> add_nodes(Decimation &work)
{
    const tl_decimate_source &source = *work.source;
    size_t count = 0;
    for (size_t i = 0; i < source.vertex_count; i++)
        count = std::max(count, static_cast<size_t>(source.weld[i]) + 1);
    std::vector<Vec> places(std::max<size_t>(count, 1), Vec(0, 0, 0));
    for (size_t i = 0; i < source.vertex_count; i++)
        places[source.weld[i]] = position_of(work, static_cast<uint32_t>(i));
    std::vector<int> node_of(places.size());
    work.nodes.reserve(places.size());
    work.mesh.reserve(places.size(), 3 * places.size(), source.triangle_count);
    for (uint32_t place : order_places(places))
        node_of[place] = add_node(work, places[place]);
    return node_of;
}

/* The triangles' numbers in the order of their first nodes. */
std::vector<uint32_t> order_triangles(const tl_decimate_source &source, const std::vector<int> &node_of)
{
    std::vector<uint32_t> order(source.triangle_count);
    auto first = [&](uint32_t t) {
        const uint32_t *v = source.triangles[t];
        return std::min({node_of[source.weld[v[0]]], node_of[source.weld[v[1]]], node_of[source.weld[v[2]]]});
    };
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        int x = first(a), y = first(b);
        return x < y || (x == y && a < b);
    });
    return order;
}

void build(Decimation &work, const tl_decimate_source &source)
{
    omerr().disable(); /* refused faces have their corners locked */
    work.source = &source;
    work.mesh.request_vertex_status();
    work.mesh.request_edge_status();
    work.mesh.request_halfedge_status();
    work.mesh.request_face_status();
    work.faces.reserve(source.triangle_count);
    work.points.resize(source.vertex_count);
    const std::vector<int> node_of = add_nodes(work);
    std::vector<uint32_t> uses(node_of.size());
    for (uint32_t t : order_triangles(source, node_of))
        add_face(work, t, node_of, uses);
    mark_lines(work);
    work.triangles = work.faces.size();
    work.longest = LONGEST * std::sqrt(4 / std::sqrt(3.0) * weigh(work) /
                                       static_cast<double>(std::max<size_t>(source.triangle_target, 1)));
}

/* ---- The order of collapses ---- */

/* Gives a node its turn when costs have come to the lowest that it can have. The true one is found then:
 * costs of neighbours that changed in the meantime have grown. */
void enqueue(Decimation &work, int node)
{
    Ring ring;
    std::array<Candidate, RING> candidates;
    double &due = work.due[static_cast<size_t>(node)];
    if (due == INFINITY && find_ring(work, node, ring) && find_candidates(work, ring, candidates) > 0)
        due = candidates[0].cost;
}

/* Takes a node's turn: collapses it, or puts it off until a dearer collapse is due, or until a neighbour
 * changes. */
void take_turn(Decimation &work, int node, double affordable, std::vector<Moved> &moved)
{
    Ring ring;
    Folded folded;
    std::array<Candidate, RING> candidates;
    double &due = work.due[static_cast<size_t>(node)];
    due = INFINITY;
    size_t count = find_ring(work, node, ring) ? find_candidates(work, ring, candidates) : 0;
    for (size_t i = 0; i < count; i++) {
        if (candidates[i].cost > affordable) {
            due = candidates[i].cost;
            return;
        }
        size_t spoke = candidates[i].spoke;
        if (!is_sound(work, ring, spoke))
            continue;
        fold(work, ring, spoke, folded);
        if (!place_all(work, ring, folded, moved))
            continue;
        collapse(work, ring, spoke, folded, moved);
        for (size_t end = 0; end < ring.count; end++)
            enqueue(work, ring.ends[end]);
        return;
    }
}

/* Sweeps over all nodes, each time with a higher cost that is affordable. A heap would keep to the exact
 * order and takes twice as long (4.9 s for 760,000 triangles): what it has first is each time on another side
 * of the body, and in no cache. */
void decimate(Decimation &work)
{
    const double step = 1.6;
    const tl_decimate_source &source = *work.source;
    const size_t first = work.triangles;
    std::vector<Moved> moved;
    work.due.assign(work.nodes.size(), INFINITY);
    for (size_t i = 0; i < work.nodes.size() && first > source.triangle_target; i++)
        enqueue(work, static_cast<int>(i));
    for (double affordable = 0; work.triangles > source.triangle_target; affordable *= step) {
        double lowest = *std::min_element(work.due.begin(), work.due.end());
        if (lowest == INFINITY)
            break;
        affordable = std::max(affordable, lowest);
        for (size_t i = 0; i < work.due.size() && work.triangles > source.triangle_target; i++)
            if (work.due[i] <= affordable)
                take_turn(work, static_cast<int>(i), affordable, moved);
        double collapsed =
            static_cast<double>(first - work.triangles) / static_cast<double>(first - source.triangle_target);
        double share = BUILDING + (1 - BUILDING) * collapsed;
        if (source.progress && !source.progress(source.user, share))
            break;
    }
}

template <typename T> T *new_array(size_t count)
{
    T *array = static_cast<T *>(std::malloc(std::max<size_t>(count, 1) * sizeof(T)));
    if (!array)
        throw std::bad_alloc();
    return array;
}

void write_result(const Decimation &work, tl_decimated *out)
{
    out->triangles = new_array<uint32_t[3]>(work.triangles);
    out->sources = new_array<uint32_t>(work.triangles);
    std::vector<uint32_t> face_of(work.source->triangle_count, UINT32_MAX);
    for (size_t f = 0; f < work.faces.size(); f++)
        if (!work.mesh.status(OpenMesh::FaceHandle(static_cast<int>(f))).deleted())
            face_of[work.faces[f].source] = static_cast<uint32_t>(f);
    for (uint32_t source = 0; source < face_of.size(); source++) {
        if (face_of[source] == UINT32_MAX)
            continue;
        const Facet &face = work.faces[face_of[source]];
        size_t t = out->triangle_count++;
        std::copy(face.corners.begin(), face.corners.end(), out->triangles[t]);
        out->sources[t] = source;
    }
    double squared = 0;
    for (const Point &point : work.points)
        squared = std::max(squared, point.squared);
    out->distance_m = std::sqrt(squared);
}

} // namespace

bool tl_decimate(const struct tl_decimate_source *source, struct tl_decimated *out)
{
    *out = tl_decimated{};
    try {
        Decimation work;
        build(work, *source);
        decimate(work);
        write_result(work, out);
        return true;
    } catch (const std::exception &) {
        tl_decimated_release(out);
        return false;
    }
}

void tl_decimated_release(struct tl_decimated *decimated)
{
    std::free(decimated->triangles);
    std::free(decimated->sources);
    *decimated = tl_decimated{};
}
