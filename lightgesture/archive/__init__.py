"""Many inputs: which are to be done, who does them, what is told of them.

`decoding.decode` puts the parts together: tasks, the archive folder with its lock and manifest, and one of
three ways to run them (this process, worker processes, a Dask cluster), all of which tell what happens by the
same messages.
"""
