"""Pictures, streams and recordings of cameras."""
