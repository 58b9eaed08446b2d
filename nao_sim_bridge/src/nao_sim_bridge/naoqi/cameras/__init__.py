"""ALVideoDevice, ALPhotoCapture and ALVideoRecorder."""
