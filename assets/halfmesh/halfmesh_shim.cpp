extern "C" {
#include "assets/halfmesh/halfmesh.h"
#include "assets/halfmesh/sector.h"
}

/* In OpenMesh's properties, which are inlined. Clang has no such warning. */
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

namespace
{

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Weights = std::array<double, 3>;

/* New edges may be this many times as long as the sides of equal triangles of the cage's number. */
constexpr double LONGEST = 3;

/* Edges are flipped each time that so many vertices are left. */
constexpr double STAGE = 0.5;

/* A face of the mesh by its number there, which it keeps while its neighbours vanish. */
struct Face {
    std::array<int, 3> corners; /* vertices of the mesh */
    double rest[3][2];
    std::vector<size_t> points; /* source vertices that were removed and lie here */
};

struct Located {
    size_t point;
    int face;
    Weights weights; /* of the face's corners */
};

/* The mesh, and what belongs to it and is not OpenMesh's. */
struct Work {
    Mesh mesh;
    std::vector<size_t> source; /* of each mesh vertex: its vertex in the source */
    std::vector<char> held;     /* of each mesh vertex */
    std::vector<Face> faces;
    std::vector<Weights> weights; /* [source vertex] in the face whose `points` name it */
    double longest = 0;           /* m, for new edges */
    size_t refused = 0;
};

/* A sector around a vertex of the mesh, the hub. */
struct Around {
    tl_sector sector;
    size_t target; /* the spoke whose end the hub moves to */
    std::array<int, TL_SECTOR_FACES> faces;
    std::array<size_t, TL_SECTOR_FACES> slots; /* of the hub among each face's corners */
    std::array<int, TL_SECTOR_FACES + 1> ends; /* the spokes' other vertices */
};

/* All faces around a vertex, laid out: one sector within a piece, up to two on a line that leads through. */
struct Neighbourhood {
    int hub = -1; /* -1: to be found again */
    bool usable;  /* false: the vertex stays */
    size_t count;
    Around sectors[2];
};

bool is_line(const Mesh &mesh, OpenMesh::HalfedgeHandle half)
{
    OpenMesh::EdgeHandle edge = mesh.edge_handle(half);
    return mesh.is_boundary(edge) || mesh.status(edge).feature();
}

/* Adds a face to a sector. */
void add_face(const Work &work, OpenMesh::FaceHandle handle, int hub, Around &around)
{
    const Face &face = work.faces[static_cast<size_t>(handle.idx())];
    size_t n = around.sector.face_count++, slot = face.corners[0] == hub ? 0 : face.corners[1] == hub ? 1 : 2;
    around.faces[n] = handle.idx();
    around.slots[n] = slot;
    for (size_t k = 0; k < 3; k++)
        std::memcpy(around.sector.rest[n][k], face.rest[(slot + k) % 3], sizeof face.rest[0]);
    around.ends[n] = face.corners[(slot + 1) % 3];
    around.ends[n + 1] = face.corners[(slot + 2) % 3];
}

/* Collects the faces counter-clockwise from an outgoing half-edge to the next line, or once around. False
 * when there are too many; a sector outside the border has none. */
bool collect(const Work &work, OpenMesh::HalfedgeHandle start, Around &around)
{
    const Mesh &mesh = work.mesh;
    OpenMesh::HalfedgeHandle half = start;
    int hub = mesh.from_vertex_handle(start).idx();
    around.sector.face_count = 0;
    do {
        OpenMesh::FaceHandle face = mesh.face_handle(half);
        if (!face.is_valid())
            break;
        if (around.sector.face_count == TL_SECTOR_FACES)
            return false;
        add_face(work, face, hub, around);
        half = mesh.ccw_rotated_halfedge_handle(half);
    } while (half != start && !is_line(mesh, half));
    return true;
}

/* False where the vertex must stay: where lines end, cross, or bend too many ways to be laid out. */
bool find_sectors(const Work &work, OpenMesh::VertexHandle hub, Neighbourhood &out)
{
    const Mesh &mesh = work.mesh;
    OpenMesh::HalfedgeHandle starts[2];
    size_t lines = 0;
    for (OpenMesh::HalfedgeHandle half : mesh.voh_range(hub)) {
        if (is_line(mesh, half)) {
            if (lines == 2)
                return false;
            starts[lines++] = half;
        } else if (lines == 0) {
            starts[0] = half;
        }
    }
    if (lines == 1)
        return false;
    out.count = 0;
    for (OpenMesh::HalfedgeHandle start : starts) {
        if (!start.is_valid())
            continue;
        Around &around = out.sectors[out.count];
        around.sector.closed = lines == 0;
        if (!collect(work, start, around))
            return false;
        if (around.sector.face_count == 0)
            continue;
        out.count++;
        if (!tl_sector_lay_out(&around.sector))
            return false;
    }
    return out.count > 0;
}

/* Sets the sectors' targets. False when the hub is on a line that does not lead to the target. */
bool aim(Neighbourhood &around, int target)
{
    for (size_t i = 0; i < around.count; i++) {
        Around &sector = around.sectors[i];
        size_t last = sector.sector.face_count, spoke = 0, step = sector.sector.closed ? 1 : last;
        while (spoke <= last && sector.ends[spoke] != target)
            spoke += step;
        if (spoke > last)
            return false;
        sector.target = spoke;
    }
    return true;
}

/* Orders weights of a face's corners as a sector does, the hub first, and back. */
Weights from_hub(const Weights &corners, size_t slot)
{
    return {corners[slot], corners[(slot + 1) % 3], corners[(slot + 2) % 3]};
}
Weights to_corners(const double found[3], size_t slot)
{
    Weights corners;
    for (size_t k = 0; k < 3; k++)
        corners[(slot + k) % 3] = found[k];
    return corners;
}

/* The place of a point of face `n` of a sector after the collapse. */
Located locate(const Around &around, size_t n, size_t point, const Weights &weights, double &inside)
{
    double found[3];
    size_t face = tl_sector_locate(&around.sector, around.target, n, weights.data(), found, &inside);
    return {point, around.faces[face], to_corners(found, around.slots[face])};
}

/* Applies a collapse to the faces: their shapes, corners and points. */
void collapse(Work &work, const Neighbourhood &neighbourhood, int target)
{
    std::vector<Located> moved;
    Located of_hub{};
    double best = -INFINITY, inside;
    for (size_t i = 0; i < neighbourhood.count; i++) {
        const Around &around = neighbourhood.sectors[i];
        for (size_t n = 0; n < around.sector.face_count; n++) {
            Face &face = work.faces[static_cast<size_t>(around.faces[n])];
            for (size_t point : face.points)
                moved.push_back(
                    locate(around, n, point, from_hub(work.weights[point], around.slots[n]), inside));
            face.points.clear();
        }
        Located here =
            locate(around, 0, work.source[static_cast<size_t>(neighbourhood.hub)], {1, 0, 0}, inside);
        if (inside > best) {
            best = inside;
            of_hub = here;
        }
    }
    moved.push_back(of_hub);
    for (const Located &located : moved) {
        work.weights[located.point] = located.weights;
        work.faces[static_cast<size_t>(located.face)].points.push_back(located.point);
    }
    for (size_t i = 0; i < neighbourhood.count; i++) {
        const Around &around = neighbourhood.sectors[i];
        for (size_t n = 0; n < around.sector.face_count; n++) {
            if (!tl_sector_keeps(&around.sector, around.target, n))
                continue;
            Face &face = work.faces[static_cast<size_t>(around.faces[n])];
            double rest[3][2];
            size_t slot = around.slots[n];
            tl_sector_rest(&around.sector, around.target, n, rest);
            face.corners[slot] = target;
            for (size_t k = 0; k < 3; k++)
                std::memcpy(face.rest[(slot + k) % 3], rest[k], sizeof rest[k]);
        }
    }
}

/* Sets a face's corner and its rest. */
void set_corners(Face &face, const int corners[3], const double rest[3][2])
{
    for (size_t k = 0; k < 3; k++) {
        face.corners[k] = corners[k];
        std::memcpy(face.rest[k], rest[k], sizeof face.rest[k]);
    }
}

/* Collects the quadrilateral around an edge within a piece, as a sector around the edge's first end. */
bool collect_pair(const Work &work, OpenMesh::EdgeHandle edge, Around &around)
{
    const Mesh &mesh = work.mesh;
    OpenMesh::HalfedgeHandle half = mesh.halfedge_handle(edge, 0);
    if (is_line(mesh, half) || !mesh.is_flip_ok(edge))
        return false;
    int hub = mesh.from_vertex_handle(half).idx();
    OpenMesh::FaceHandle faces[2] = {mesh.face_handle(mesh.opposite_halfedge_handle(half)),
                                     mesh.face_handle(half)};
    around.sector.face_count = 0;
    around.sector.closed = false;
    for (OpenMesh::FaceHandle face : faces)
        add_face(work, face, hub, around);
    return tl_sector_lay_out(&around.sector);
}

/* Flips an edge if that makes its triangles better. */
bool flip(Work &work, OpenMesh::EdgeHandle edge)
{
    Around around;
    if (!collect_pair(work, edge, around) || !tl_sector_should_flip(&around.sector))
        return false;
    Face *pair[2] = {&work.faces[static_cast<size_t>(around.faces[0])],
                     &work.faces[static_cast<size_t>(around.faces[1])]};
    const int hub = pair[0]->corners[around.slots[0]], *ends = around.ends.data();
    const int corners[2][3] = {{hub, ends[0], ends[2]}, {ends[1], ends[2], ends[0]}};
    work.mesh.flip(edge);
    /* OpenMesh keeps both faces, in an order of its own: the one with the hub is found by its corners. */
    bool swapped = true;
    for (OpenMesh::VertexHandle v : work.mesh.fv_range(OpenMesh::FaceHandle(around.faces[0])))
        swapped = swapped && v.idx() != hub;
    std::vector<size_t> points[2];
    for (size_t n = 0; n < 2; n++)
        for (size_t point : pair[n]->points) {
            double found[3];
            size_t to = tl_sector_flipped_locate(
                &around.sector, n, from_hub(work.weights[point], around.slots[n]).data(), found);
            work.weights[point] = {found[0], found[1], found[2]};
            points[to].push_back(point);
        }
    for (size_t to = 0; to < 2; to++) {
        double rest[3][2];
        tl_sector_flipped_rest(&around.sector, to, rest);
        set_corners(*pair[swapped ? 1 - to : to], corners[to], rest);
        pair[swapped ? 1 - to : to]->points = std::move(points[to]);
    }
    return true;
}

/* Flips edges until all are Delaunay's, or for a few passes. */
void improve(Work &work)
{
    const int passes = 8;
    bool flipped = true;
    for (int pass = 0; flipped && pass < passes; pass++) {
        flipped = false;
        for (size_t e = 0; e < work.mesh.n_edges(); e++) {
            OpenMesh::EdgeHandle edge(static_cast<int>(e));
            if (!work.mesh.status(edge).deleted())
                flipped = flip(work, edge) || flipped;
        }
    }
}

/* The decimater's only module: it judges collapses, and follows them. A line along a face that vanishes stays
 * one: of the edges that become one OpenMesh keeps the target's, and the hub's are none (find_sectors). */
template <class MeshT> class CageModule : public OpenMesh::Decimater::ModBaseT<MeshT>
{
  public:
    DECIMATING_MODULE(CageModule, MeshT, Cage);

    explicit CageModule(MeshT &mesh) : Base(mesh, false) {}
    void follow(Work *work) { work_ = work; }

    float collapse_priority(const CollapseInfo &info) override
    {
        if (work_->held[static_cast<size_t>(info.v0.idx())] &&
            !work_->held[static_cast<size_t>(info.v1.idx())])
            return Base::ILLEGAL_COLLAPSE;
        if (!look_at(info.v0) || !aim(around_, info.v1.idx()))
            return Base::ILLEGAL_COLLAPSE;
        double worst = 0;
        for (size_t i = 0; i < around_.count; i++) {
            double length = tl_sector_judge(&around_.sectors[i].sector, around_.sectors[i].target);
            if (!(length >= 0 && length <= work_->longest))
                return Base::ILLEGAL_COLLAPSE;
            worst = std::max(worst, length);
        }
        return static_cast<float>(worst);
    }

    /* Collapses that were judged, and so visit the vertex without fail. */
    void preprocess_collapse(const CollapseInfo &info) override
    {
        if (look_at(info.v0) && aim(around_, info.v1.idx()))
            collapse(*work_, around_, info.v1.idx());
        around_.hub = -1;
    }

  private:
    /* The decimater judges all collapses of one vertex before those of the next. */
    bool look_at(OpenMesh::VertexHandle hub)
    {
        if (around_.hub != hub.idx()) {
            around_.usable = find_sectors(*work_, hub, around_);
            around_.hub = hub.idx();
        }
        return around_.usable;
    }

    Work *work_ = nullptr;
    Neighbourhood around_;
};

OpenMesh::VertexHandle add_vertex(Work &work, const tl_cage_source &source, size_t vertex)
{
    work.source.push_back(vertex);
    work.held.push_back(source.held[vertex]);
    return work.mesh.add_vertex(Mesh::Point(0, 0, 0));
}

/* Adds a face. If it is refused, it gets three vertices of its own; they and those that they stand for stay,
 * so that the cage is joined where the cloth is. */
void add_face(Work &work, const tl_cage_source &source, size_t triangle)
{
    const uint32_t *v = source.triangles[triangle];
    auto handle = [](uint32_t vertex) { return OpenMesh::VertexHandle(static_cast<int>(vertex)); };
    OpenMesh::VertexHandle corners[3] = {handle(v[0]), handle(v[1]), handle(v[2])};
    if (!work.mesh.add_face(corners, 3).is_valid()) {
        work.refused++;
        for (size_t k = 0; k < 3; k++) {
            work.mesh.status(corners[k]).set_locked(true);
            corners[k] = add_vertex(work, source, v[k]);
            work.mesh.status(corners[k]).set_locked(true);
        }
        work.mesh.add_face(corners, 3);
    }
    Face face;
    for (size_t k = 0; k < 3; k++) {
        face.corners[k] = corners[k].idx();
        for (size_t c = 0; c < 2; c++)
            face.rest[k][c] = static_cast<double>(source.rest[triangle][k][c]);
    }
    work.faces.push_back(face);
}

void mark_seams(Work &work, const tl_cage_source &source)
{
    for (size_t t = 0; t < source.triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            if (!source.seams[t][k])
                continue;
            const std::array<int, 3> &v = work.faces[t].corners;
            OpenMesh::HalfedgeHandle half = work.mesh.find_halfedge(OpenMesh::VertexHandle(v[(k + 1) % 3]),
                                                                    OpenMesh::VertexHandle(v[(k + 2) % 3]));
            work.mesh.status(work.mesh.edge_handle(half)).set_feature(true);
        }
}

double area_of(const Work &work)
{
    double area = 0;
    for (const Face &face : work.faces) {
        const double(*p)[2] = face.rest;
        area +=
            std::fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) /
            2;
    }
    return area;
}

void build(Work &work, const tl_cage_source &source)
{
    omerr().disable(); /* refused faces are counted */
    work.mesh.request_vertex_status();
    work.mesh.request_edge_status();
    work.mesh.request_halfedge_status();
    work.mesh.request_face_status();
    work.weights.resize(source.vertex_count);
    for (size_t i = 0; i < source.vertex_count; i++)
        add_vertex(work, source, i);
    for (size_t t = 0; t < source.triangle_count; t++)
        add_face(work, source, t);
    mark_seams(work, source);
}

/* Vertices of the source that triangles use. */
size_t count_used(const tl_cage_source &source)
{
    std::vector<char> used(source.vertex_count);
    for (size_t t = 0; t < source.triangle_count; t++)
        for (size_t k = 0; k < 3; k++)
            used[source.triangles[t][k]] = 1;
    return static_cast<size_t>(std::count(used.begin(), used.end(), 1));
}

void decimate(Work &work, size_t used, size_t vertex_target)
{
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(work.mesh);
    CageModule<Mesh>::Handle handle;
    decimater.add(handle);
    decimater.module(handle).follow(&work);
    work.longest =
        LONGEST * std::sqrt(2 / std::sqrt(3.0) * area_of(work) / static_cast<double>(vertex_target));
    decimater.initialize();
    for (size_t left = used; left > vertex_target;) {
        size_t next = std::max(vertex_target, static_cast<size_t>(STAGE * static_cast<double>(left)));
        improve(work);
        size_t collapses = left > next ? decimater.decimate(left - next) : 0;
        if (collapses == 0)
            break;
        left -= collapses;
    }
    improve(work);
}

template <typename T> T *new_array(size_t count)
{
    T *array = static_cast<T *>(std::malloc(std::max<size_t>(count, 1) * sizeof(T)));
    if (!array)
        throw std::bad_alloc();
    return array;
}

void write_cage(const Work &work, const tl_cage_source &source, tl_cage *out)
{
    constexpr uint32_t none = UINT32_MAX;
    std::vector<uint32_t> number(source.vertex_count, none);
    std::vector<size_t> left;
    for (size_t f = 0; f < work.faces.size(); f++) {
        if (work.mesh.status(OpenMesh::FaceHandle(static_cast<int>(f))).deleted())
            continue;
        left.push_back(f);
        for (int corner : work.faces[f].corners)
            number[work.source[static_cast<size_t>(corner)]] = 0;
    }
    for (uint32_t &n : number)
        n = n == none ? none : static_cast<uint32_t>(out->vertex_count++);
    out->triangle_count = left.size();
    out->refused = work.refused;
    out->vertices = new_array<uint32_t>(out->vertex_count);
    out->triangles = new_array<uint32_t[3]>(left.size());
    out->rest = new_array<float[3][2]>(left.size());
    out->points = new_array<tl_cage_point>(source.vertex_count);
    for (size_t i = 0; i < source.vertex_count; i++) {
        out->points[i] = {none, {0, 0, 0}};
        if (number[i] != none)
            out->vertices[number[i]] = static_cast<uint32_t>(i);
    }
    for (size_t t = 0; t < left.size(); t++) {
        const Face &face = work.faces[left[t]];
        for (size_t k = 0; k < 3; k++) {
            size_t vertex = work.source[static_cast<size_t>(face.corners[k])];
            out->triangles[t][k] = number[vertex];
            for (size_t c = 0; c < 2; c++)
                out->rest[t][k][c] = static_cast<float>(face.rest[k][c]);
            out->points[vertex] = {static_cast<uint32_t>(t),
                                   {k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0}};
        }
        for (size_t point : face.points) {
            const Weights &weights = work.weights[point];
            out->points[point] = {static_cast<uint32_t>(t), {weights[0], weights[1], weights[2]}};
        }
    }
}

} // namespace

bool tl_cage_make(const struct tl_cage_source *source, size_t vertex_target, struct tl_cage *out)
{
    *out = tl_cage{};
    try {
        Work work;
        build(work, *source);
        size_t used = count_used(*source), target = std::max<size_t>(vertex_target, 3);
        if (used > target)
            decimate(work, used, target);
        write_cage(work, *source, out);
        return true;
    } catch (const std::exception &) {
        tl_cage_release(out);
        return false;
    }
}

void tl_cage_release(struct tl_cage *cage)
{
    std::free(cage->vertices);
    std::free(cage->triangles);
    std::free(cage->rest);
    std::free(cage->points);
    *cage = tl_cage{};
}
