"""The process modules of a NAO: manipulation, navigation, speech, lights and vision."""
