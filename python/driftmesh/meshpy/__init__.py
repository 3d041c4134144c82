"""The calls of MeshPy for meshes in the plane: `import driftmesh.meshpy.triangle as triangle`."""
