"""Many meshes: a chain of filters over files, in processes of this machine or on the workers of a Dask cluster.

    python -m pymeshlab_multires denoise low_pass cutoff=0.8 "scans/**/*.ply" -o clean -j 4

arguments.py   the command line, and the files it means
chain.py       filters with their values, or an .mlx, as steps that can be sent to another process
mesh.py        one mesh: loaded, filtered, written beside its place and renamed
child.py       the process a mesh is worked on in, so that a crash costs that mesh alone
memory.py      how much a mesh will take, and room for only as many at once as fit
run.py         all of them, here or over Dask
journal.py     what became of each: a journal to resume from, the table of the reports, the log of errors
"""
