// SPDX-License-Identifier: GPL-3.0-or-later
// Receives what an OpenMesh reader reads as plain arrays. OpenMesh's own importer builds half-edges, and so
// splits vertices where the mesh is not manifold and keeps one normal a vertex; this one changes nothing.
#pragma once

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mesh_scan.h"
#include "source_mesh.h"

namespace opaline {

class SoupImporter final : public OpenMesh::IO::BaseImporter {
 public:
  explicit SoupImporter(const MeshScan& scan);

  // what was read, for comparison with the scan
  std::size_t vertices() const { return vertices_; }
  std::size_t collapsed() const { return collapsed_; }
  std::uint64_t corners() const { return hash_.value(); }
  const std::vector<Vec3d>& positions() const { return mesh_.positions; }
  const std::vector<Triangle>& triangles() const { return mesh_.triangles; }

  /// The mesh, with the file's positions in double where the scan has them.
  SourceMesh take(const std::vector<Vec3d>& exact_positions);

  // ---- OpenMesh's side ----------------------------------------------------------------------------------
  using Handle = OpenMesh::VertexHandle;
  Handle add_vertex(const OpenMesh::Vec3f& p) override;
  Handle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
  OpenMesh::FaceHandle add_face(const VHandles& corners) override;
  void set_point(Handle v, const OpenMesh::Vec3f& p) override;
  void set_normal(Handle v, const OpenMesh::Vec3f& n) override;
  void set_normal(Handle v, const OpenMesh::Vec3d& n) override { set_normal(v, OpenMesh::Vec3f(n)); }
  bool is_triangle_mesh() const override { return true; }
  std::size_t n_vertices() const override { return mesh_.positions.size(); }
  std::size_t n_faces() const override { return mesh_.triangles.size(); }
  std::size_t n_edges() const override { return 0; }

  // asked for by none of the four readers, or of no use to a triangle soup
  OpenMesh::HalfedgeHandle add_edge(Handle, Handle) override { return OpenMesh::HalfedgeHandle(); }
  OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle) override { return OpenMesh::FaceHandle(); }
  void add_face_texcoords(OpenMesh::FaceHandle, Handle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, Handle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(OpenMesh::FaceHandle, int) override {}
  void set_halfedge(Handle, OpenMesh::HalfedgeHandle) override {}
  void set_color(Handle, const OpenMesh::Vec3uc&) override {}
  void set_color(Handle, const OpenMesh::Vec4uc&) override {}
  void set_color(Handle, const OpenMesh::Vec3f&) override {}
  void set_color(Handle, const OpenMesh::Vec4f&) override {}
  void set_texcoord(Handle, const OpenMesh::Vec2f&) override {}
  void set_status(Handle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(OpenMesh::HalfedgeHandle, OpenMesh::HalfedgeHandle) override {}
  void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(Handle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  bool vertex_normals_;
  SourceMesh mesh_;
  std::size_t vertices_ = 0, collapsed_ = 0;
  CornerHash hash_;
};

}  // namespace opaline
