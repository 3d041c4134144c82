// The page that report_page fills, whole, as the build made it (report/build.mjs); empty if it made none.
  .section .rodata
  .balign 16
  .global driftmesh_report_page
driftmesh_report_page:
  .incbin DRIFTMESH_REPORT_PAGE
  .global driftmesh_report_page_end
driftmesh_report_page_end:
  .byte 0
  .section .note.GNU-stack, "", @progbits
