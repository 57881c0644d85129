"""Runs roadbed's batches on a Dask cluster, and their results as Parquet tables."""
