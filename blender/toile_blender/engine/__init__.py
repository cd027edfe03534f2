"""Everything that needs no Blender: files of Toile, its process, axes.  Tested by plain Python with NumPy."""
