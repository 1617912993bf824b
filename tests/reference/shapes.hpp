/// \file shapes.hpp
/// Meshes of the reference tests, made here so that they do not depend on scree's generators, and their motions.
#ifndef SCREE_REFERENCE_SHAPES_HPP
#define SCREE_REFERENCE_SHAPES_HPP

#include <string>

#include "exact_overlap.hpp"

namespace reference
{

/// splitmix64 (Steele, Lea & Flood 2014).
class Random
{
  public:
    explicit Random(uint64_t seed) : state(seed) {}
    uint64_t bits();
    double uniform();                           ///< [0, 1)
    double uniform(double lower, double upper); ///< [lower, upper)
    double log_uniform(double lower, double upper);
    double normal();
    int integer(int lower, int upper); ///< both included
    Vector direction();

  private:
    uint64_t state;
};

using Matrix = std::array<Vector, 3>;
Matrix rotation(const Vector &axis, double angle);
Matrix random_rotation(Random &random);
/// One of the 24 rotations of the cube: entries -1, 0, 1.
Matrix lattice_rotation(int index);

Vector operator+(const Vector &a, const Vector &b);
Vector operator-(const Vector &a, const Vector &b);
Vector operator*(double s, const Vector &a);
Vector operator*(const Matrix &m, const Vector &a);
double dot(const Vector &a, const Vector &b);
Vector cross(const Vector &a, const Vector &b);
double norm(const Vector &a);

Mesh moved(Mesh mesh, const Matrix &m, const Vector &shift); ///< m x + shift, rounded
Mesh shifted(Mesh mesh, const Vector &shift);
Mesh scaled(Mesh mesh, double factor);
Mesh stretched(Mesh mesh, const Vector &factors);
Mesh joined(const Mesh &a, const Mesh &b); ///< two pieces in one mesh
double extent(const Mesh &mesh);           ///< largest edge of the box
/// Same body, vertices and triangles in another order, triangles starting at another corner.
Mesh shuffled(const Mesh &mesh, Random &random);

/// Boundary of tetrahedra, which become the cells.
Mesh mesh_of_cells(std::vector<Vector> vertices, std::vector<Cell> cells);
Mesh mesh_of_triangles(std::vector<Vector> vertices, std::vector<Triangle> triangles);

Mesh box(const Vector &lower, const Vector &upper);
Mesh cube(double size);          ///< centred
Mesh tetrahedron(double radius); ///< regular
Mesh octahedron(double radius);
Mesh schoenhardt(double radius);
/// Icosahedron with every edge cut into `frequency`, on the sphere: 20 frequency^2 triangles.
Mesh sphere(double radius, int frequency);
/// Star-shaped, mildly concave.
Mesh rock(uint64_t seed, int frequency, double roughness);
/// Prism over a triangulated polygon.
Mesh extrusion(const std::vector<std::array<double, 2>> &points, const std::vector<Triangle> &triangles, double lower,
               double upper);
Mesh l_shape(double width); ///< in [0, 1]^2 x [0, width]
Mesh u_shape(double width);
Mesh comb(int num_teeth, double width);
Mesh ring(double inner, int num_corners, double width); ///< outer radius 1, hole of radius `inner`
Mesh prism(int num_corners, double height);             ///< in a circle of radius 1
Mesh bipyramid(int num_corners, double height);         ///< two vertices of valence num_corners
/// Box whose top is cut into slivers of the given aspect ratio by vertices near an edge.
Mesh sliver_box(double aspect, Random &random);

/// A shape by number, 0 <= index < num_shapes(): from 4 to about 1000 triangles, convex and not, extent about 1.
int num_shapes();
Mesh shape(int index, Random &random);
std::string shape_name(int index);

} // namespace reference

#endif
